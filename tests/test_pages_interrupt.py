"""A reader who presses the stop button: in each cell of a page, once. The cell is then run again, and the page goes on."""

from __future__ import annotations

import asyncio
from pathlib import Path
from random import Random
from threading import Timer
from typing import Any

import pytest
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from nbformat import v4
from test_pages import PAGES, code_cells

LESSONS = [page for page in PAGES if page.stem[0].isdigit()]
LATEST = 0.25
"""Until when (s) a cell is interrupted: most cells are done by then, and the button was pressed for nothing."""


def interrupted(client: NotebookClient, cell: Any, index: int, delay: float) -> str:
    """Run a cell, interrupt it after `delay` s; the name of the error in which it ended, or ''."""
    button = Timer(delay, lambda: asyncio.run(client.km.interrupt_kernel()))
    button.start()
    try:
        client.execute_cell(cell, index)
    except CellExecutionError as error:
        return str(error.ename)
    finally:
        button.join()
    return ""


@pytest.mark.parametrize("page", LESSONS, ids=lambda page: page.stem)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_an_interrupted_cell_can_be_run_again(page: Path) -> None:
    cells = code_cells(page)
    notebook = v4.new_notebook(cells=cells)
    client = NotebookClient(
        notebook, timeout=60, kernel_name="python3", resources={"metadata": {"path": str(page.parent)}}
    )
    chance = Random(page.stem)
    with client.setup_kernel():
        for index, cell in enumerate(cells):
            ended = interrupted(client, cell, index, chance.uniform(0, LATEST))
            assert ended in ("", "KeyboardInterrupt", "CommandInterrupted") or "raises-exception" in cell.metadata.tags, cell.source
            again = client.execute_cell(cell, index)  # raises CellExecutionError if it fails now
            said = "".join(output.text for output in again.outputs if output.get("name") == "stderr")
            assert "Traceback" not in said, cell.source
