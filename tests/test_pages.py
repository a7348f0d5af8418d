"""The pages as a reader treats them: every cell run twice."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient

PAGES = sorted((Path(__file__).resolve().parents[1] / "notebooks").glob("*.ipynb"))


def run(cells: list[Any], page: Path) -> list[Any]:
    """Run cells in a fresh kernel; the cells with their outputs. Raises CellExecutionError if one of them fails."""
    notebook = nbformat.v4.new_notebook(cells=cells)
    NotebookClient(
        notebook, timeout=60, kernel_name="python3", resources={"metadata": {"path": str(page.parent)}}
    ).execute()
    return notebook.cells


def code_cells(page: Path) -> list[Any]:
    notebook = nbformat.read(page, as_version=4)
    return [copy_of(cell) for cell in notebook.cells if cell.cell_type == "code"]


def copy_of(cell: Any) -> Any:
    """The same code, not yet run; with its tags, one of which says that an error is wanted."""
    return nbformat.v4.new_code_cell(cell.source, metadata={"tags": cell.metadata.get("tags", [])})


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_every_cell_can_be_run_twice(page: Path) -> None:
    twice = [copy_of(cell) for cell in code_cells(page) for _ in range(2)]
    outputs = [output for cell in run(twice, page) for output in cell.outputs]
    said = "".join(output.text for output in outputs if output.get("name") == "stderr")
    assert "Traceback" not in said
    assert "Warning" not in said  # one of Python's own; a command may well say WARNING


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_it_is_stored_as_it_was_run(page: Path) -> None:
    notebook = nbformat.read(page, as_version=4)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in cells] == list(range(1, len(cells) + 1))
    assert all(len(cell.source.splitlines()) <= 15 for cell in cells)
