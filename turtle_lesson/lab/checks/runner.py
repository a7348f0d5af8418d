"""Carrying a check out: every expectation is looked at, whatever the others come to. Nothing but Ctrl-C gets out of here."""

from __future__ import annotations

from .exam import Exam, Place
from .registry import Check, Expectation
from .result import CheckResult
from .rows import BAD, GOOD, OPEN, CannotLook, Row


def run(check: Check, place: Place) -> CheckResult:
    """Look at everything that a check expects of the system at `place`."""
    if place.ended:
        return CheckResult(check.name, check.title, check.page, check.points, _over(check), 0.0)
    began = place.now
    with Exam(place, check.limit) as exam:
        rows = tuple(_look(each, exam) for each in check.expectations)
    seconds = round(place.now - began, 3)
    return CheckResult(check.name, check.title, check.page, check.points, rows, seconds)


def _over(check: Check) -> tuple[Row, ...]:
    """What is said of a world that has ended."""
    step = "Use the lesson that start() returned last, or run the set-up cell again."
    gone = Row(BAD, "a world to look at", "it was closed by a later start()", step)
    rest = (Row(OPEN, each.expected, _because("the world has ended")) for each in check.expectations)
    return gone, *rest


def _look(expectation: Expectation, exam: Exam) -> Row:
    try:
        good, words, next_step = expectation.look(exam)
    except CannotLook as reason:
        return Row(OPEN, expectation.expected, _because(str(reason)))
    except Exception as error:  # whatever a learner's classes may do
        return Row(BAD, expectation.expected, f"looking at it raised {_named(error)}", _ODD)
    return Row(GOOD if good else BAD, expectation.expected, words, "" if good else next_step)


_ODD = "Run the cells from the set-up cell on again; if it stays, compare your interfaces and types with the page's."


def _because(reason: str) -> str:
    return f"not looked at, because {reason}"


def _named(error: Exception) -> str:
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text[:200]}" if text else type(error).__name__
