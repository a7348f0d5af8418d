"""Carries a check out: looks at every expectation, whatever the others come to, and raises nothing but KeyboardInterrupt."""

from __future__ import annotations

from ...ros.sim.errors import learners_frames
from .assertions import NO_ERROR
from .failures import STOP_ADVICE, in_words, row_of
from .probe import Probe, Target
from .registry import Check, Expectation
from .results import BAD, GOOD, OPEN, STOPPED, Advice, CannotLook, CheckResult, Row, Seen, Stopped

ENDS = "every callback returns"


def run(check: Check, target: Target) -> CheckResult:
    """Look at everything that a check expects of the system at `target`."""
    began = target.now
    if target.ended:
        step = "Use the lesson that start() returned last, or run the set-up cell again."
        rows = [Row(BAD, "a world to look at", "it was closed by a later start()", Advice(step, step))]
        rows += [Row(OPEN, each.expected, _because("the world has ended")) for each in check.expectations]
    else:
        with Probe(target, check.limit) as probe:
            rows = _with_errors([_look(each, probe) for each in check.expectations], probe)
    seconds = round(target.now - began, 3)
    return CheckResult(check.name, check.title, check.page, check.points, tuple(rows), seconds, check.learnt)


def _look(expectation: Expectation, probe: Probe) -> Row:
    try:
        seen = Seen(*expectation.look(probe))
    except Stopped:
        return Row(OPEN, expectation.expected, _because("your code was stopped"))
    except CannotLook as reason:
        return Row(OPEN, expectation.expected, _because(str(reason)))
    except Exception as error:  # whatever a learner's classes may do
        if learners_frames(error.__traceback__):
            return row_of(error, expectation.expected)
        return Row(BAD, expectation.expected, f"looking at it raised {in_words(error)}", _ODD)
    if seen.good:
        return Row(GOOD, expectation.expected, seen.words)
    advice = seen.advice if isinstance(seen.advice, Advice) else Advice(direction=seen.advice)
    return Row(BAD, expectation.expected, seen.words, advice)


_ODD = Advice(
    direction="Run the cells from the set-up cell on again; if it stays, compare your interfaces and types with the page's."
)


def _with_errors(rows: list[Row], probe: Probe) -> list[Row]:
    """The rows with the learner's own error first, since it explains the others; nothing is added to a good result."""
    if probe.stopped:
        return [Row(STOPPED, ENDS, probe.stopped, STOP_ADVICE), *(row for row in rows if row.mark != STOPPED)]
    error = next(iter(probe.errors()), None)
    if error is None or all(row.good for row in rows):
        return sorted(rows, key=lambda row: not row.trace)
    first = row_of(error, NO_ERROR)
    return [first, *(row for row in rows if row.expected != NO_ERROR and row.trace != first.trace)]


def _because(reason: str) -> str:
    return f"not looked at, because {reason}"
