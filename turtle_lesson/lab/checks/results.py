"""What looking at expectations gives: a row for each (✓, ✗, –, ■), and the table that `lesson.check` answers.

The learner's own errors become rows, too: in a few lines, and callbacks that have not returned by name and line.
"""

from __future__ import annotations

import html
import textwrap
import traceback
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from traceback import FrameSummary
from typing import Any, NamedTuple

from rclpy import executors

from ...ros.sim import errors
from ...ros.sim.errors import DriveTimeout, NeverReturns
from ...ros.sim.strand import Strand
from ..words import count, number, shortened

GOOD, BAD, OPEN, STOPPED = "✓", "✗", "–", "■"


class CannotLook(Exception):
    """This cannot be looked at; the message completes "not looked at, because …"."""


class Stopped(CannotLook):
    """The learner's code let no time pass and was stopped; the message says where."""


@dataclass(frozen=True, slots=True)
class Advice:
    """What is said of a ✗, in three steps: at the first failure of a check, at the second, and from the third on.

    Attributes:
        symptom: what the fault looks like, where the row's own words do not say it yet.
        direction: where to look, or what to think about; not the line to write.
        hint: which hint to open ("Open Hint 2 under the exercise."); shown together with the direction.
    """

    symptom: str = ""
    direction: str = ""
    hint: str = ""

    def after(self, failures: int) -> str:
        """What is said when a check has failed so many times in a row."""
        if failures <= 1:
            return self.symptom
        return self.direction if failures == 2 else " ".join(filter(None, (self.direction, self.hint)))


def hinted(direction: str, hint: int | str) -> Advice:
    """Advice that from the third failure on also names a hint of the exercise: its number, or a sentence."""
    return Advice(direction=direction, hint=f"Open Hint {hint} under the exercise." if isinstance(hint, int) else hint)


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a result."""

    mark: str
    expected: str
    seen: str
    advice: Advice = Advice()
    """Only where the mark is ✗ or ■."""
    trace: str = ""
    """Lines of the learner's code in which an error came up, outermost first."""

    @property
    def good(self) -> bool:
        """Whether it is as expected."""
        return self.mark == GOOD

    @staticmethod
    def unseen(expected: str, reason: str) -> Row:
        """The row of an expectation that could not be looked at."""
        return Row(OPEN, expected, f"not looked at, because {reason}")

    @staticmethod
    def stopped(expected: str, where: str) -> Row:
        """The row that says where the learner's code was stopped."""
        return Row(STOPPED, expected, where, STOP_ADVICE)


class Seen(NamedTuple):
    """What was seen: whether it is as expected, in words, and advice if it is not; a plain text is the direction."""

    good: bool
    words: str
    advice: str | Advice = ""

    def row(self, expected: str) -> Row:
        """The row of an expectation."""
        if self.good:
            return Row(GOOD, expected, self.words)
        advice = self.advice if isinstance(self.advice, Advice) else Advice(direction=self.advice)
        return Row(BAD, expected, self.words, advice)


NO_ERROR = "no error meanwhile"
"""What is expected of every learner's code, whatever else a check expects."""

METADATA = "turtle_lesson_check"
"""The key of an output's metadata under which the figures of a result are, for programs that read notebooks; no proof."""

WIDTH = 100
"""Characters in a line of the plain table."""

WIDEST = 50
"""Characters of its middle column at most; a longer expectation pushes what was seen into the next line."""

POINTER = "The hints are below the exercise: open the first one."
"""What is said from the third failure on, where no row names a hint of its own."""


@dataclass(frozen=True)
class CheckResult:
    """The rows of one check. All of them have to be ✓ to earn its points."""

    name: str
    title: str
    page: str
    points: int
    rows: tuple[Row, ...]
    seconds: float
    """Robot time that went by."""
    learnt: str = ""
    """What the exercise teaches, in a sentence; shown when the check is passed."""
    failures: int = 1
    """How often the check has failed in a row, this time included: decides how much advice is shown."""
    so_far: str = ""
    """The points of the page and in all, in words; shown when the check is passed."""

    @property
    def passed(self) -> bool:
        """Whether everything is as expected."""
        return bool(self.rows) and all(row.good for row in self.rows)

    @property
    def mark(self) -> str:
        """✓, ✗, or ■ where the learner's code had to be stopped."""
        return GOOD if self.passed else STOPPED if any(row.mark == STOPPED for row in self.rows) else BAD

    @property
    def earned(self) -> int:
        """All of the points, or none."""
        return self.points if self.passed else 0

    def figures(self) -> dict[str, Any]:
        """What a collector of points needs, as JSON can hold it."""
        rows = [
            {
                "mark": row.mark,
                "expected": row.expected,
                "seen": "; ".join(filter(None, (row.seen, *row.trace.splitlines()))),
                "next": row.advice.direction,
            }
            for row in self.rows
        ]
        own = {name: getattr(self, name) for name in ("name", "page", "points", "earned", "passed")}
        return {**own, "rows": rows}

    def _parts(self) -> tuple[str, list[str], str]:
        """What is said above the rows and below them, and how much robot time it took.

        Below them is what was learnt and the points so far, or where the hints are.
        """
        done = f"{sum(row.good for row in self.rows)} of {count(len(self.rows), 'expectation')} met"
        points = f"{self.earned} of {count(self.points, 'point')}"
        title = f"{self.name}: {'stopped; ' if self.mark == STOPPED else ''}{done}, {points}. {self.title}"
        closing = [self.learnt, self.so_far] if self.passed else []
        if self.failures > 2 and not (self.passed or any(row.advice.hint for row in self.rows)):
            closing = [POINTER]
        time = f"{number(self.seconds, 1)} s of robot time went by." if self.seconds else "No robot time went by."
        return title, [line for line in closing if line], time

    def _groups(self) -> list[list[Row]]:
        """The rows in their order; those that were not looked at for the same reason stand together, at the first."""
        groups: dict[object, list[Row]] = {}
        for index, row in enumerate(self.rows):
            groups.setdefault(row.seen if row.mark == OPEN else index, []).append(row)
        return list(groups.values())

    def __repr__(self) -> str:
        title, closing, time = self._parts()
        groups = self._groups()
        wide = min(max((len(group[0].expected) for group in groups if len(group) == 1), default=0), WIDEST)
        lines = _wrapped(f"{self.mark} {title}", "", "  ")
        for row, *more in groups:
            lines += _wrapped(_folded(row, more), f"  {OPEN} ", "    ") if more else self._plain_row(row, wide)
        for line in closing:
            lines += _wrapped(line, "  ", "  ")
        return "\n".join([*lines, time])

    def _plain_row(self, row: Row, wide: int) -> Iterator[str]:
        first, other = f"  {row.mark} {row.expected.ljust(wide)}  ", " " * (wide + 6)
        if len(row.expected) > wide:
            yield from _wrapped(row.expected, f"  {row.mark} ", "    ")
            first = other
        yield from _wrapped(row.seen, first, other)
        for line in row.trace.splitlines():
            yield from _wrapped(line, "        ", "          ")
        if said := row.advice.after(self.failures):
            yield from _wrapped(said, "      → ", "        ")

    def _repr_html_(self) -> str:
        title, closing, time = self._parts()
        _, colour, name = _LOOKS[self.mark]
        rows = "".join(self._html_row(row, more) for row, *more in self._groups())
        below = "".join(f'<p style="margin: 0.4em 0">{html.escape(line)}</p>' for line in closing)
        return (
            f'<div style="border-left: 4px solid var(--jp-{name}-color1, {colour}); padding-left: 0.8em">'
            f'<p style="margin: 0.4em 0">{_html_mark(self.mark)} <strong>{html.escape(title)}</strong></p>'
            f'<table style="border-collapse: collapse; max-width: 60rem; color: inherit; font-size: inherit">'
            f"<thead><tr><td></td><th {_CELL}>expected</th><th {_CELL}>seen</th></tr></thead>"
            f"<tbody>{rows}</tbody></table>{below}<p><small>{time}</small></p></div>"
        )

    def _html_row(self, row: Row, more: list[Row]) -> str:
        if more:
            names = "".join(f"<li>{html.escape(each.expected)}</li>" for each in (row, *more))
            summary = f"<summary>{html.escape(_folded(row, more))}</summary>"
            folded = f"<details>{summary}<ul>{names}</ul></details>"
            return f'<tr><td {_CELL}>{_html_mark(OPEN)}</td><td {_CELL} colspan="2">{folded}</td></tr>'
        seen = html.escape(row.seen)
        if row.trace:
            seen += f'<pre style="white-space: pre-wrap; margin: 0.3em 0">{html.escape(row.trace)}</pre>'
        if said := row.advice.after(self.failures):
            seen += f"<div><em>→ {html.escape(said)}</em></div>"
        cells = (_html_mark(row.mark), html.escape(row.expected), seen)
        return f"<tr>{''.join(f'<td {_CELL}>{cell}</td>' for cell in cells)}</tr>"

    def _repr_mimebundle_(self, **options: object) -> Any:
        """What Jupyter shows, and as metadata of the output the figures."""
        return {"text/plain": repr(self), "text/html": self._repr_html_()}, {METADATA: self.figures()}


_CELL = 'style="text-align: left; vertical-align: top; white-space: normal; padding: 0.2em 1em 0.2em 0"'
_LOOKS = {
    GOOD: ("yes", "#1a7f37", "success"),
    BAD: ("no", "#cf222e", "error"),
    OPEN: ("not looked at", "#6e7781", ""),
    STOPPED: ("stopped", "#9a6700", "warn"),
}
"""Each mark in words, its colour, and what JupyterLab calls that. White on each colour has a contrast of 4.5 : 1 or more, and
each stands out from a light and from a dark page."""


def _folded(row: Row, more: list[Row]) -> str:
    return f"{len(more) + 1} more expectations were {row.seen}"


def _html_mark(mark: str) -> str:
    words, colour, _ = _LOOKS[mark]
    style = (
        f"display: inline-block; width: 1.5em; line-height: 1.5em; border-radius: 0.4em; text-align: center; "
        f"color: #fff; background: {colour}"
    )
    return f'<strong role="img" aria-label="{words}" style="{style}">{mark}</strong>'


def _wrapped(text: str, first: str, other: str) -> list[str]:
    lines = textwrap.wrap(text, WIDTH, initial_indent=first, subsequent_indent=other, break_on_hyphens=False)
    return [line.rstrip() for line in lines] or [first.rstrip()]


# -- errors of the learner's code -----------------------------------------------------------------------------------------

MOST_FRAMES = 4
"""Lines of a learner's code that are shown of one error: the innermost ones."""

ENDLESS = (NeverReturns, DriveTimeout)
"""The errors by which code is stopped that never returns: it computes on and on, or waits again and again."""

STOP_ADVICE = Advice(
    "It was stopped because it would have run forever, and nothing else could happen in its node.",
    "A callback does a little and returns; a timer calls it again. To wait, let a timer or another callback continue.",
)
READ = Advice(direction="Read the error first, then the line above it: what has each name in it at that moment?")


def in_words(error: BaseException) -> str:
    """The kind and the words of an error: "TypeError: unsupported operand …"."""
    text = shortened(" ".join(str(error).split()), 200)
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def row_of(error: BaseException, expected: str) -> Row:
    """The row about an error of the learner's code."""
    if isinstance(error, ENDLESS):
        return Row.stopped(expected, never_returned(error))
    return Row(BAD, expected, in_words(error), READ, _trace_of(error))


def _trace_of(error: BaseException) -> str:
    """The learner's lines that led to an error, outermost first, and the advice that the error carries."""
    if errors.before_showing is not None:
        errors.before_showing(error)
    own = [each for each in traceback.extract_tb(error.__traceback__) if not errors.is_ours(each.filename)]
    lines = []
    for each in own[-MOST_FRAMES:]:
        file = errors.shown_path(each.filename)
        place = "" if file == "a cell of this notebook" else f"{file}, "
        inside = "" if each.name == "<module>" else f" in {each.name}"
        lines.append(f"{place}line {each.lineno}{inside}: {each.line}")
    return "\n".join([*lines, *map(str, getattr(error, "__notes__", ()))])


def never_returned(error: BaseException) -> str:
    """Which callback went on without end, and in which line it was stopped."""
    calls = traceback.extract_tb(error.__traceback__)
    inside = _in_a_callback(calls) or _learners(calls)
    return _where(inside, "stopped") if inside else "something that was called has not returned, and was stopped"


def unreturned(strands: list[Strand]) -> list[str]:
    """The callbacks that parked strands stand in, each as "on_request has not returned: it is in line 7 (`…`)"."""
    stacks = [traceback.extract_stack(each.frame) for each in strands if each.frame is not None]
    return [_where(inside, "it is") for inside in map(_in_a_callback, stacks) if inside]


def _where(calls: Sequence[FrameSummary], words: str) -> str:
    callback = "the program" if calls[0].name == "<module>" else calls[0].name
    return f"{callback} has not returned: {words} in line {calls[-1].lineno} (`{calls[-1].line}`)"


def _in_a_callback(calls: Sequence[FrameSummary]) -> list[FrameSummary]:
    """The learner's own calls within a callback that an executor runs, outermost first: the callback is the first."""
    spinning = [index for index, each in enumerate(calls) if each.filename == executors.__file__]
    return _learners(calls[spinning[-1] :]) if spinning else []


def _learners(calls: Sequence[FrameSummary]) -> list[FrameSummary]:
    return [call for call in calls if errors.is_learners(call.filename)]
