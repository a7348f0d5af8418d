"""A reader who runs a cell, runs it again and presses the stop button, and runs it once more: each cell of each page."""

from __future__ import annotations

import os
import re
from pathlib import Path
from random import Random
from time import monotonic

import pytest
from nbclient.exceptions import CellExecutionError
from nbformat import v4
from test_pages import PAGES, client_in, code_cells

LESSONS = [page for page in PAGES if page.stem[0].isdigit()][:: 1 if os.environ.get("TURTLE_LESSON_ALL_PAGES") else 3]
"""Every third page: all of them take eight minutes (TURTLE_LESSON_ALL_PAGES=1)."""
# The button is pressed in the kernel, and only while a cell runs: an interrupt that comes while ipykernel sends its
# answer takes that answer away, with any notebook.
BUTTON = """
def _button():
    import signal
    shell = get_ipython()
    real = {name: getattr(signal, name, None) for name in ("raise_signal", "setitimer")}  # a program's own are its world's
    def before(info):
        real["setitimer"](signal.ITIMER_REAL, shell.meta.pop("stop_after", 0.0))
    def after(*_):
        real["setitimer"](signal.ITIMER_REAL, 0.0)
    def alarm(number, frame):
        handled = signal.getsignal(signal.SIGINT) is not signal.default_int_handler  # somebody minds it: a world that runs
        each = frame
        while each:
            if each.f_code.co_name == "__del__" or each.f_code.co_filename.endswith("weakref.py"):
                return real["setitimer"](signal.ITIMER_REAL, 0.001)  # where Python itself would only print the interrupt
            each = each.f_back
        while frame and (frame.f_globals is not shell.user_global_ns or frame.f_code in (before.__code__, after.__code__)):
            frame = frame.f_back
        if frame or handled:
            shell.meta["stopped"] = True
            real["raise_signal"](signal.SIGINT)
        else:  # between IPython's own lines: not yet in the cell, or no longer
            real["setitimer"](signal.ITIMER_REAL, 0.001)
    if real["setitimer"]:  # Windows has no such signals: there each cell is just run three times
        signal.signal(signal.SIGALRM, alarm)
        shell.events.register("pre_run_cell", before)
        shell.events.register("post_execute", after)
_button()
"""


@pytest.mark.parametrize("page", LESSONS, ids=lambda page: page.stem)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_an_interrupted_cell_can_be_run_again(page: Path, tmp_path: Path) -> None:
    cells = code_cells(page)
    client = client_in(tmp_path, v4.new_notebook(cells=[*cells, v4.new_code_cell()]))
    chance = Random(page.stem)

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
        """Whether the button was pressed in the cell before.

        How such a cell ends does not tell: an interrupt may be handled, it is only printed where Python takes something
        apart, and IPython fails with an error of its own if it comes where Python has no line number for it.
        """
        return bool(run("if get_ipython().meta.pop('stopped', False): raise KeyboardInterrupt")[0])

    with client.setup_kernel():
        run(BUTTON)
        for cell in cells:
            wanted = "raises-exception" in cell.metadata.tags
            began = monotonic()
            run(cell.source)
            run(f"get_ipython().meta['stop_after'] = {chance.uniform(0, monotonic() - began)}")
            ended, said = run(cell.source)
            if was_stopped():
                ended, said = run(cell.source)
            assert not ended or wanted, ended
            assert "Traceback" not in said, said
            assert not re.search(r"\wWarning: ", said), (
                said
            )  # one of Python's own; CMake may well say "CMake Warning at"
