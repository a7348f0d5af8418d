"""Answers to the exercises of the pages: wrong ones, which must fail, and right but unusual ones, which must pass.

`page_NN.py` holds those of a page as `ANSWERS`, by the name of the check:

    ANSWERS = {
        "counter": Answers(
            wrong={"starts at 0": (changed(COUNTER, ("number = 0", "number = -1")), "the first number was 0")},
            right={"a generator": "..."},
        )
    }

An answer is the source of the exercise's cell (several sources are several cells), or an `Answer`, which replaces earlier
cells, too. With a wrong one stands a text that a row which is not ✓ must say. `test_answers.py` runs them all:

    pytest tests/checks/test_answers.py -k "page_03 and short_way"
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

NOTEBOOKS = Path(__file__).resolve().parents[2] / "notebooks"


@dataclass(frozen=True)
class Answer:
    """What a learner has typed.

    Attributes:
        code: in place of the exercise's cell: one cell, or several.
        cells: in place of earlier cells, each named by a text that is in it alone. They are run again, with all that
            follow, as by a learner who goes back and changes them.
    """

    code: str | tuple[str, ...]
    cells: Mapping[str, str] = field(default_factory=dict)

    @property
    def sources(self) -> tuple[str, ...]:
        """The sources of its cells."""
        return (self.code,) if isinstance(self.code, str) else self.code


Given = str | tuple[str, ...] | Answer


@dataclass(frozen=True)
class Answers:
    """The answers to one exercise, each with a label; a wrong one with a text that is to be said of it."""

    wrong: Mapping[str, tuple[Given, str]]
    right: Mapping[str, Given]


def answer(given: Given) -> Answer:
    """What was given, as an Answer."""
    return given if isinstance(given, Answer) else Answer(given)


def changed(source: str, *changes: tuple[str, str]) -> str:
    """A source in which each (old, new) is replaced, everywhere. Raises ValueError for a text that is not in it."""
    for old, new in changes:
        if old not in source:
            raise ValueError(f"{old!r} is not in the source any more:\n{source}")
        source = source.replace(old, new)
    return source


def code_cells(page: str) -> list[dict[str, Any]]:
    """The code cells of a published page: source, tags and the name of the exercise ("" for none)."""
    cells = json.loads((NOTEBOOKS / f"{page}.ipynb").read_text(encoding="utf-8"))["cells"]
    return [
        {
            "source": "".join(cell["source"]),
            "tags": cell["metadata"].get("tags", []),
            "exercise": cell["metadata"].get("turtle_lesson", {}).get("exercise", ""),
        }
        for cell in cells
        if cell["cell_type"] == "code"
    ]


def stub(page: str, exercise: str) -> str:
    """The source of an exercise's cell as it is published."""
    return _tagged(page, exercise, "exercise")


def solution(page: str, exercise: str) -> str:
    """The source of an exercise's folded solution, without its first line."""
    return _tagged(page, exercise, "solution").partition("\n")[2]


def _tagged(page: str, exercise: str, tag: str) -> str:
    [source] = [c["source"] for c in code_cells(page) if tag in c["tags"] and c["exercise"] == exercise]
    return source
