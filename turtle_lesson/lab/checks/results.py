"""What looking at expectations gives: a row for each (✓, ✗, –, ■), and the table that `lesson.check` answers."""

from __future__ import annotations

import html
import textwrap
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

from ..words import count, number

GOOD, BAD, OPEN, STOPPED = "✓", "✗", "–", "■"
IN_WORDS = {GOOD: "yes", BAD: "no", OPEN: "not looked at", STOPPED: "stopped"}


class CannotLook(Exception):
    """This cannot be looked at; the message completes "not looked at, because …"."""


class OutOfTime(CannotLook):
    """The robot time of the check is over."""


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


class Seen(NamedTuple):
    """What was seen: whether it is as expected, in words, and advice if it is not; a plain text is the direction."""

    good: bool
    words: str
    advice: str | Advice = ""


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


METADATA = "turtle_lesson_check"
"""Where an output's metadata holds the figures of a result, for a program that reads notebooks; they prove nothing."""

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
    def stopped(self) -> bool:
        """Whether the learner's code had to be stopped."""
        return any(row.mark == STOPPED for row in self.rows)

    @property
    def earned(self) -> int:
        """All of the points, or none."""
        return self.points if self.passed else 0

    @property
    def good(self) -> int:
        """How many rows are ✓."""
        return sum(row.good for row in self.rows)

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
        return {
            "name": self.name,
            "page": self.page,
            "points": self.points,
            "earned": self.earned,
            "passed": self.passed,
            "rows": rows,
        }

    # -- in words ----------------------------------------------------------------------------------------------------

    @property
    def mark(self) -> str:
        """✓, ✗, or ■ where the learner's code was stopped."""
        return GOOD if self.passed else STOPPED if self.stopped else BAD

    @property
    def _words(self) -> str:
        done = f"{self.good} of {count(len(self.rows), 'expectation')} met"
        points = f"{self.earned} of {count(self.points, 'point')}"
        return f"{self.name}: {'stopped; ' if self.stopped else ''}{done}, {points}. {self.title}"

    @property
    def footnote(self) -> str:
        """How much robot time it took."""
        return f"{number(self.seconds, 1)} s of robot time went by." if self.seconds else "No robot time went by."

    @property
    def closing(self) -> list[str]:
        """What is said below the rows: what was learnt and the points so far, or where the hints are."""
        if self.passed:
            return [line for line in (self.learnt, self.so_far) if line]
        own = any(row.advice.hint for row in self.rows)
        return [POINTER] if self.failures > 2 and not own else []

    def _groups(self) -> Iterator[list[Row]]:
        """The rows in their order; those that were not looked at for the same reason stand together, at the first."""
        for index, row in enumerate(self.rows):
            if row.mark != OPEN:
                yield [row]
            elif all(row.seen != before.seen for before in self.rows[:index]):
                yield [each for each in self.rows[index:] if (each.mark, each.seen) == (OPEN, row.seen)]

    def __repr__(self) -> str:
        closing = [line for each in self.closing for line in _wrapped(each, "  ", "  ")]
        return "\n".join(
            [*_wrapped(f"{self.mark} {self._words}", "", "  "), *self._plain_rows(), *closing, self.footnote]
        )

    def _plain_rows(self) -> Iterable[str]:
        groups = list(self._groups())
        wide = min(max((len(group[0].expected) for group in groups if len(group) == 1), default=0), WIDEST)
        for row, *more in groups:
            if more:
                yield from _wrapped(_folded(row, more), f"  {OPEN} ", "    ")
                continue
            first = f"  {row.mark} {row.expected.ljust(wide)}  "
            if len(row.expected) > wide:
                yield from _wrapped(row.expected, f"  {row.mark} ", "    ")
                first = " " * (wide + 6)
            yield from _wrapped(row.seen, first, " " * (wide + 6))
            for line in row.trace.splitlines():
                yield from _wrapped(line, "        ", "          ")
            if said := row.advice.after(self.failures):
                yield from _wrapped(said, "      → ", "        ")

    # -- in a notebook -----------------------------------------------------------------------------------------------

    def _repr_html_(self) -> str:
        rows = "".join(self._html_row(row, more) for row, *more in self._groups())
        closing = "".join(f'<p style="margin: 0.4em 0">{html.escape(line)}</p>' for line in self.closing)
        return (
            f'<div style="border-left: 4px solid {_EDGES[self.mark]}; padding-left: 0.8em">'
            f'<p style="margin: 0.4em 0">{_html_mark(self.mark)} <strong>{html.escape(self._words)}</strong></p>'
            f'<table style="border-collapse: collapse; max-width: 60rem; color: inherit; font-size: inherit">'
            f"<thead><tr><td></td><th {_CELL}>expected</th><th {_CELL}>seen</th></tr></thead>"
            f"<tbody>{rows}</tbody></table>{closing}<p><small>{self.footnote}</small></p></div>"
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

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> Any:
        """What Jupyter shows, and as metadata of the output the figures."""
        return {"text/plain": repr(self), "text/html": self._repr_html_()}, {METADATA: self.figures()}


_CELL = 'style="text-align: left; vertical-align: top; white-space: normal; padding: 0.2em 1em 0.2em 0"'
_GREEN, _RED, _GREY, _BROWN = "#1a7f37", "#cf222e", "#6e7781", "#9a6700"
_BADGES = {GOOD: _GREEN, BAD: _RED, OPEN: _GREY, STOPPED: _BROWN}
"""White on each of these has a contrast of 4.5 : 1 or more, and each stands out from a light and from a dark page."""
_EDGES = {
    GOOD: f"var(--jp-success-color1, {_GREEN})",
    BAD: f"var(--jp-error-color1, {_RED})",
    STOPPED: f"var(--jp-warn-color1, {_BROWN})",
}


def _folded(row: Row, more: list[Row]) -> str:
    return f"{len(more) + 1} more expectations were {row.seen}"


def _html_mark(mark: str) -> str:
    style = (
        f"display: inline-block; width: 1.5em; line-height: 1.5em; border-radius: 0.4em; text-align: center; "
        f"color: #fff; background: {_BADGES[mark]}"
    )
    return f'<strong role="img" aria-label="{IN_WORDS[mark]}" style="{style}">{mark}</strong>'


def _wrapped(text: str, first: str, other: str) -> list[str]:
    lines = textwrap.wrap(text, WIDTH, initial_indent=first, subsequent_indent=other, break_on_hyphens=False)
    return [line.rstrip() for line in lines] or [first.rstrip()]
