"""`atexit` in a simulated process: what a program registers is called when that process ends.

What a library registers while a program imports it is left to Python itself: the library is there for all processes.
"""

from __future__ import annotations

import sys
from functools import partial
from typing import Any

from ..process import Process
from ..strand import Strand, getcurrent
from ..tracebacks import is_library


def register(real: Any, func: Any, /, *args: Any, **kwargs: Any) -> Any:
    """Have a function called at the end."""
    process = _process()
    if process is None:
        return real(func, *args, **kwargs)
    if not callable(func):
        raise TypeError("the first argument must be callable")
    process.exit_functions.append(partial(func, *args, **kwargs))
    return func


def unregister(real: Any, func: Any, /) -> None:
    """No longer have it called."""
    process = _process()
    if process is None:
        real(func)
    else:
        kept = [each for each in process.exit_functions if not isinstance(each, partial) or each.func != func]
        process.exit_functions[:] = kept


def exit_now(real: Any, status: int) -> None:
    """`os._exit`: the process ends here and now, and nothing is cleaned up."""
    strand = getcurrent()
    if type(strand) is not Strand or strand.process.is_notebook:
        real(status)
    else:
        strand.process.end_now(status)


def _process() -> Process | None:
    """The running process, if it is its own program that calls."""
    strand = getcurrent()
    if type(strand) is not Strand or strand.process.is_notebook:
        return None
    return None if is_library(sys._getframe(2).f_code.co_filename) else strand.process
