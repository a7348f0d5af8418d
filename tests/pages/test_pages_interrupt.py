"""A reader who runs a cell, runs it again and presses the stop button, and runs it once more: each cell of each page."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from answers.client import PageServer
from answers.stopped import problem
from nbclient.exceptions import CellExecutionError
from nbformat import v4
from test_pages import PAGES, client_in, code_cells

LESSONS = [page for page in PAGES if page.stem[0].isdigit()][:: 1 if os.environ.get("TURTLE_LESSON_ALL_PAGES") else 3]
"""Every third page: all of them take eight minutes (TURTLE_LESSON_ALL_PAGES=1)."""
IN_A_KERNEL = LESSONS if os.environ.get("TURTLE_LESSON_ALL_PAGES") else LESSONS[1:2]
"""Those that are also run in a kernel; it takes twice as long. `tests/soak` stops many kinds of cell in one."""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no forks")
@pytest.mark.parametrize("page", LESSONS, ids=lambda page: page.stem)
def test_an_interrupted_cell_can_be_run_again(page_server: PageServer, page: Path) -> None:
    running = page_server.page(page.stem, stopped=True)
    found = running.reply()
    running.close()
    assert not found, found


@pytest.mark.parametrize("page", IN_A_KERNEL, ids=lambda page: page.stem)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_an_interrupted_cell_can_be_run_again_in_a_kernel(page: Path, tmp_path: Path) -> None:
    cells = code_cells(page)
    client = client_in(tmp_path, v4.new_notebook(cells=[*cells, v4.new_code_cell()]))

    def run(source: str) -> tuple[str, str]:
        """Run code: the error in which it ended, or '', and what it said on stderr."""
        cell = v4.new_code_cell(source)
        try:
            client.execute_cell(cell, len(cells))
            ended = ""
        except CellExecutionError as error:
            ended = str(error)
        return ended, "".join(output.text for output in cell.outputs if output.get("name") == "stderr")

    def was_stopped() -> bool:
        """Whether the button was pressed in the cell before."""
        return bool(run("if get_ipython().meta.pop('stopped', False): raise KeyboardInterrupt")[0])

    wanted = [(cell.source, "raises-exception" in cell.metadata.tags) for cell in cells]
    with client.setup_kernel():
        run("%xmode Minimal")  # nobody reads the stacks, each of which takes up to half a second to be written
        wrong = problem(
            wanted, page.stem, run, lambda seconds: run(f"get_ipython().meta['stop_after'] = {seconds}"), was_stopped
        )
    assert not wrong, wrong
