"""Runs each cell of a page, runs it again and presses the stop button at a random moment, and runs it once more.

The button is pressed in the process of the cells, and only while a cell runs: an interrupt that comes while ipykernel sends its
answer takes that answer away, with any notebook.
"""

from __future__ import annotations

import contextlib
import io
import re
from collections.abc import Callable
from random import Random
from time import monotonic
from typing import Any

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


def fault(source: str, ended: str, said: str, error_is_wanted: bool) -> str:
    """What is wrong with a cell that ended in this error ("" for none), and said this on stderr; "" if nothing is."""
    if ended and not error_is_wanted:
        return f"{ended}\nin:\n{source}"
    # One of Python's own warnings; CMake may well say "CMake Warning at".
    wrong = "Traceback" in said or re.search(r"\wWarning: ", said)
    return f"{said}\nby:\n{source}" if wrong else ""


def problem(
    cells: list[tuple[str, bool]],
    name: str,
    run: Callable[[str], tuple[str, str]],
    stop_after: Callable[[float], object],
    was_stopped: Callable[[], bool],
) -> str:
    """Run cells, each with whether an error is wanted, and stop each once: the first thing that is wrong, or "".

    Args:
        name: the page's, which decides about the moments.
        run: runs code; the error in which it ended, or "", and what it said on stderr.
        stop_after: has the button be pressed so many seconds after the next cell begins.
        was_stopped: whether it was pressed in the last one.
    """
    chance = Random(name)
    run(BUTTON)
    for source, wanted in cells:
        began = monotonic()
        run(source)
        stop_after(chance.uniform(0, monotonic() - began))
        ended, said = run(source)
        # How a stopped cell ends does not tell that it was: an interrupt may be handled, it is only printed where Python takes
        # something apart, and IPython fails with an error of its own if it comes where Python has no line number for it.
        if was_stopped():
            ended, said = run(source)
        if wrong := fault(source, ended, said, wanted):
            return wrong
    return ""


def problem_here(shell: Any, cells: list[tuple[str, bool]], name: str) -> str:
    """The same in a shell of this process."""

    def run(source: str) -> tuple[str, str]:
        """Run code: the error in which it ended, or '', and what it said on stderr."""
        printed, said = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(said):
            done = shell.run_cell(source, store_history=True)
        error = done.error_before_exec or done.error_in_exec
        ended = "" if error is None else f"{type(error).__name__}: {error}\n{printed.getvalue()[-4000:]}"
        return ended, said.getvalue()

    def stop_after(seconds: float) -> None:
        shell.meta["stop_after"] = seconds

    return problem(cells, name, run, stop_after, lambda: shell.meta.pop("stopped", False))
