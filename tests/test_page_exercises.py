"""The exercises of the pages: a published stub fails its check, and every folded solution passes it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat
import pytest
from test_pages import PAGES, run

LESSONS = [page for page in PAGES if page.stem[0].isdigit()]


def cells_of(page: Path) -> list[Any]:
    return [cell for cell in nbformat.read(page, as_version=4).cells if cell.cell_type == "code"]


def tagged(cells: list[Any], tag: str) -> list[Any]:
    return [cell for cell in cells if tag in cell.metadata.get("tags", [])]


def solved(page: Path) -> list[Any]:
    """The page's code with each solution in place of its stub."""
    cells = cells_of(page)
    solutions = {cell.metadata.turtle_lesson.exercise: cell.source for cell in tagged(cells, "solution")}
    for cell in tagged(cells, "exercise"):
        first, _, body = solutions[cell.metadata.turtle_lesson.exercise].partition("\n")
        assert first.startswith("%%solution ")
        cell.source = body
    return [nbformat.v4.new_code_cell(cell.source, metadata={"tags": cell.metadata.get("tags", [])}) for cell in cells]


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


@pytest.mark.parametrize("page", LESSONS, ids=lambda page: page.stem)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_every_solution_passes_its_check(page: Path) -> None:
    cells = solved(page)
    executed = run(cells, page)
    for cell in tagged(executed, "check"):
        said = cell.outputs[-1].data["text/plain"]
        assert said.startswith("✓"), said
