"""What `lesson.check` answers: a table, for the eyes and in plain text, and its figures for who collects points."""

from __future__ import annotations

import html
import textwrap
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from ..words import count, number
from .rows import GOOD, IN_WORDS, Row

METADATA = "turtle_lesson_check"
"""Where an output's metadata holds the figures of a result: what `turtle-lesson grade` reads."""

WIDTH = 100
"""Characters in a line of the plain table."""

WIDEST = 50
"""Characters of its middle column at most; a longer expectation pushes what was seen into the next line."""


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

    @property
    def passed(self) -> bool:
        """Whether everything is as expected."""
        return bool(self.rows) and all(row.good for row in self.rows)

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
            {"mark": row.mark, "expected": row.expected, "seen": row.seen, "next": row.next_step} for row in self.rows
        ]
        return {
            "name": self.name,
            "page": self.page,
            "points": self.points,
            "earned": self.earned,
            "passed": self.passed,
            "rows": rows,
        }

    # -- as text -----------------------------------------------------------------------------------------------------

    @property
    def headline(self) -> str:
        """The result in one line."""
        done = f"{self.good} of {count(len(self.rows), 'expectation')} met"
        points = f"{self.earned} of {count(self.points, 'point')}"
        return f"{GOOD if self.passed else '✗'} {self.name}: {done}, {points}. {self.title}"

    @property
    def footnote(self) -> str:
        """How much robot time it took."""
        return f"{number(self.seconds, 1)} s of robot time went by." if self.seconds else "No robot time went by."

    def __repr__(self) -> str:
        return "\n".join([*_wrapped(self.headline, "", "  "), *self._plain_rows(), self.footnote])

    def _plain_rows(self) -> Iterable[str]:
        wide = min(max((len(row.expected) for row in self.rows), default=0), WIDEST)
        for row in self.rows:
            first = f"  {row.mark} {row.expected.ljust(wide)}  "
            if len(row.expected) > wide:
                yield from _wrapped(row.expected, f"  {row.mark} ", "    ")
                first = " " * (wide + 6)
            yield from _wrapped(row.seen, first, " " * (wide + 6))
            if row.next_step:
                yield from _wrapped(row.next_step, "      → ", "        ")

    # -- in a notebook -----------------------------------------------------------------------------------------------

    def _repr_html_(self) -> str:
        head = "".join(f"<th {_CELL}>{word}</th>" for word in ("", "expected", "seen"))
        rows = "".join(map(_html_row, self.rows))
        return (
            f"<p><strong>{html.escape(self.headline)}</strong></p>"
            f'<table style="border-collapse: collapse; max-width: 60rem"><thead><tr>{head}</tr></thead>'
            f"<tbody>{rows}</tbody></table><p><small>{self.footnote}</small></p>"
        )

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> Any:
        """What Jupyter shows, and as metadata of the output the figures."""
        return {"text/plain": repr(self), "text/html": self._repr_html_()}, {METADATA: self.figures()}


_CELL = 'style="text-align: left; vertical-align: top; white-space: normal"'


def _html_row(row: Row) -> str:
    next_step = f"<br><em>→ {html.escape(row.next_step)}</em>" if row.next_step else ""
    mark = f'<span role="img" aria-label="{IN_WORDS[row.mark]}"><strong>{row.mark}</strong></span>'
    seen = f"{html.escape(row.seen)}{next_step}"
    return f"<tr><td {_CELL}>{mark}</td><td {_CELL}>{html.escape(row.expected)}</td><td {_CELL}>{seen}</td></tr>"


def _wrapped(text: str, first: str, other: str) -> list[str]:
    lines = textwrap.wrap(text, WIDTH, initial_indent=first, subsequent_indent=other, break_on_hyphens=False)
    return [line.rstrip() for line in lines] or [first.rstrip()]
