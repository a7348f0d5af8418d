"""A reader who runs a cell, runs it again and presses the stop button, and runs it once more: each cell of each page."""

from __future__ import annotations

from pathlib import Path
from random import Random
from time import monotonic

import pytest
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from nbformat import v4
from test_pages import PAGES, code_cells

LESSONS = [page for page in PAGES if page.stem[0].isdigit()]
STOPS = ("", "KeyboardInterrupt", "CommandInterrupted")

# The button is pressed in the kernel, and only while a cell runs: an interrupt that comes while ipykernel sends its
# answer takes that answer away, with any notebook.
BUTTON = """
def _button():
    import signal
    shell = get_ipython()
    def before(info):
        signal.setitimer(signal.ITIMER_REAL, shell.meta.pop("stop_after", 0.0))
    def after(*_):
        signal.setitimer(signal.ITIMER_REAL, 0.0)
    press = signal.raise_signal  # the real one: a world makes it send signals to the program that runs
    signal.signal(signal.SIGALRM, lambda *_: press(signal.SIGINT))
    shell.events.register("pre_run_cell", before)
    shell.events.register("post_execute", after)
_button()
"""


@pytest.mark.parametrize("page", LESSONS, ids=lambda page: page.stem)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_an_interrupted_cell_can_be_run_again(page: Path) -> None:
    cells = code_cells(page)
    notebook = v4.new_notebook(cells=[*cells, v4.new_code_cell()])
    client = NotebookClient(
        notebook, timeout=60, kernel_name="python3", resources={"metadata": {"path": str(page.parent)}}
    )
    chance = Random(page.stem)

    def run(source: str) -> str:
        """Run code; the name of the error in which it ended, or ''."""
        try:
            client.execute_cell(v4.new_code_cell(source), len(cells))
        except CellExecutionError as error:
            return str(error.ename)
        return ""

    with client.setup_kernel():
        run(BUTTON)
        for index, cell in enumerate(cells):
            wanted = "raises-exception" in cell.metadata.tags
            began = monotonic()
            run(cell.source)
            delay = chance.uniform(0, monotonic() - began)
            run(f"get_ipython().meta['stop_after'] = {delay}")
            assert run(cell.source) in STOPS or wanted, cell.source
            again = client.execute_cell(cell, index)  # raises CellExecutionError if it fails now
            said = "".join(output.text for output in again.outputs if output.get("name") == "stderr")
            assert "Traceback" not in said, cell.source
            assert "Warning" not in said, cell.source  # one of Python's own; a command may well say WARNING
