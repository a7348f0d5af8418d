"""The pages as they lie here: stored as they were run, with the figures of good pages."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient
from pages_report import row

PAGES = sorted((Path(__file__).resolve().parents[2] / "notebooks").glob("*.ipynb"))
HALF_PAGES = ("03b_answer_on_arrival",)


def client_in(folder: Path, notebook: Any) -> NotebookClient:
    """A client whose kernel begins in this folder, as that of a page which lies there."""
    os.environ.pop("TURTLE_LESSON_FOLDER", None)  # names the folder of pages that are compared by nbval
    resources = {"metadata": {"path": str(folder)}}
    return NotebookClient(notebook, timeout=120, kernel_name="python3", resources=resources)


def code_cells(page: Path) -> list[Any]:
    notebook = nbformat.read(page, as_version=4)
    return [copy_of(cell) for cell in notebook.cells if cell.cell_type == "code"]


def copy_of(cell: Any) -> Any:
    """The same code, not yet run; with its tags, one of which says that an error is wanted."""
    return nbformat.v4.new_code_cell(cell.source, metadata={"tags": cell.metadata.get("tags", [])})


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_it_is_stored_as_it_was_run(page: Path) -> None:
    notebook = nbformat.read(page, as_version=4)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in cells] == list(range(1, len(cells) + 1))
    assert all(len(cell.source.splitlines()) <= 15 for cell in cells)


@pytest.mark.parametrize("page", [page for page in PAGES if page.stem[0].isdigit()], ids=lambda page: page.stem)
def test_its_figures_are_those_of_a_good_page(page: Path) -> None:
    """What pages_report.py prints: few words and short cells, a picture early, guesses, exercises, pictures that speak."""
    _, cells, median, longest, words, _, in_a_row, picture, predictions, exercises, spoken = row(page)
    half = page.stem in HALF_PAGES
    assert (20 if half else 40) <= int(cells) <= (40 if half else 70)
    assert float(median) <= 3
    assert int(longest) <= 15
    assert 25 <= int(words) <= 35
    assert int(in_a_row) <= 3
    assert 1 <= int(picture) <= 7
    assert int(predictions) == (1 if half else 2)
    assert int(exercises) >= (2 if half or page.stem.startswith("00") else 3)
    with_text, _, pictures = spoken.partition(" of ")
    assert with_text == pictures
