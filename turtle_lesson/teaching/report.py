"""What grading has found: as a table to read, and as JSON."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Any

from .grade import CheckScore, Graded

MARKS = {"passed": "✓", "failed": "✗", "not run": "–"}
WIDTH = 110


def in_words(graded: Sequence[Graded]) -> str:
    """A block for each copy: its points, then a line for each check and for what went wrong."""
    wide = max(len(copy.path.name) for copy in graded)
    lines: list[str] = []
    for copy in graded:
        lines += ["", f"{copy.path.name.ljust(wide)}  {copy.earned:3} of {copy.points:3} points  {copy.page}".rstrip()]
        names = max((len(score.name) for score in copy.scores), default=0)
        lines += [_short(f"  {MARKS[score.state]} {score.name.ljust(names)}  {_of(score)}") for score in copy.scores]
        lines += [_short(f"  ! {each}") for each in filter(None, [copy.problem, *copy.errors])]
    return "\n".join([*lines, "", _sum(graded)]).lstrip("\n")


def _of(score: CheckScore) -> str:
    why = "it was not run" if score.state == "not run" else score.first_miss
    return f"{score.earned:2} of {score.points:2}  {why}".rstrip()


def _short(line: str) -> str:
    indent = line[: len(line) - len(line.lstrip())]
    return indent + textwrap.shorten(line.strip(), WIDTH - len(indent), placeholder=" …") if len(line) > WIDTH else line


def _sum(graded: Sequence[Graded]) -> str:
    done = sum(bool(copy.points) and copy.earned == copy.points for copy in graded)
    failed = sum(bool(copy.problem) for copy in graded)
    words = [f"{len(graded)} graded", f"{done} with all points"]
    return ", ".join(words + ([f"{failed} not run to the end"] if failed else [])) + "."


def as_json(graded: Sequence[Graded]) -> dict[str, Any]:
    """Everything: `{"copies": [{"path", "page", "earned", "points", "problem", "errors", "checks": [{…, "rows"}]}]}`."""
    return {"format": 1, "copies": [_copy(each) for each in graded]}


def _copy(copy: Graded) -> dict[str, Any]:
    return {
        "path": str(copy.path),
        "page": copy.page,
        "earned": copy.earned,
        "points": copy.points,
        "problem": copy.problem,
        "errors": copy.errors,
        "checks": [
            {"name": each.name, "state": each.state, "earned": each.earned, "points": each.points, "rows": each.rows}
            for each in copy.scores
        ],
    }
