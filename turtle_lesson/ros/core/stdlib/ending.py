"""What Python does between the end of a main program and that of its process: it waits for threads, and tidies up.

The order is CPython's: pools end their work, then the threads that are no daemons are waited for, then comes what was
given to `atexit.register`. Daemons end with the process, wherever they stand.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING

from ..tracebacks import format_error

if TYPE_CHECKING:
    import threading

    from ..process import Process


def wind_down(process: Process) -> None:
    """Wait for what is still at work in a process whose main program has ended; its main strand calls this."""
    try:
        while process.before_exit:
            process.before_exit.pop()()
        _wait_for_threads(process)
    except KeyboardInterrupt as error:  # somebody has no patience: then nobody is waited for
        print(f"Exception ignored in: <module 'threading'>\n{format_error(error)}", end="", file=sys.stderr)
    while process.exit_functions:
        _call(process.exit_functions.pop())


def _wait_for_threads(process: Process) -> None:
    if all(strand.thread is None for strand in process.strands):
        return  # by far the most programs have none
    from .identity import end, thread_of

    main = process.main_strand
    if main is not None:
        end(thread_of(main))
    while waited_for := _living(process):
        waited_for[0].join()


def _living(process: Process) -> list[threading.Thread]:
    threads = [strand.thread for strand in process.strands if strand.thread is not None and not strand.dead]
    return [thread for thread in threads if not thread.daemon and thread.is_alive()]


def _call(function: Callable[[], object]) -> None:
    try:
        function()
    except SystemExit:
        pass
    except Exception as error:
        function = getattr(function, "func", function)
        name = getattr(function, "__qualname__", repr(function))
        print(f"Exception ignored in atexit callback: <function {name}>", file=sys.stderr)
        print(format_error(error), end="", file=sys.stderr)
