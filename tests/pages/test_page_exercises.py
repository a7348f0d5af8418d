"""The exercises of the pages: each has a stub, which fails, a check, and a folded solution (test_story.py runs those)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat
import pytest
from test_pages import PAGES

LESSONS = [page for page in PAGES if page.stem[0].isdigit()]


def cells_of(page: Path) -> list[Any]:
    return [cell for cell in nbformat.read(page, as_version=4).cells if cell.cell_type == "code"]


def tagged(cells: list[Any], tag: str) -> list[Any]:
    return [cell for cell in cells if tag in cell.metadata.get("tags", [])]


@pytest.mark.parametrize("page", LESSONS, ids=lambda page: page.stem)
def test_each_exercise_has_a_stub_a_check_and_a_solution(page: Path) -> None:
    cells = cells_of(page)
    names = [cell.metadata.turtle_lesson.exercise for cell in tagged(cells, "exercise")]
    assert names, "every page has an exercise"
    assert [cell.metadata.turtle_lesson.exercise for cell in tagged(cells, "solution")] == names
    assert [cell.source for cell in tagged(cells, "check")] == [f'lesson.check("{name}")' for name in names]
    assert all(cell.metadata.jupyter.source_hidden for cell in tagged(cells, "solution"))


@pytest.mark.parametrize("page", LESSONS, ids=lambda page: page.stem)
def test_a_stub_alone_fails_its_check(page: Path) -> None:
    """What is stored; that a run says the same is what nbval compares."""
    for cell in tagged(cells_of(page), "check"):
        said = cell.outputs[-1].data["text/plain"]
        assert said.startswith("✗"), said
