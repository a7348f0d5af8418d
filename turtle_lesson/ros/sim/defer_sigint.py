"""Defers Ctrl-C, and the garbage collector, to the end of a block that must not be left half done, such as a large import.

An interrupted import leaves a package that can never be imported again in this kernel: some of its modules are loaded and
refer to a package that is gone. matplotlib's first import takes a second, which is long enough for a Ctrl-C.
This module imports nothing of the simulation, because the package's first import already needs it.
"""

from __future__ import annotations

import gc
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def defer_sigint() -> Iterator[None]:
    """Defer SIGINT to the end of the block, where it raises KeyboardInterrupt. In another thread: does nothing.

    Nor does the garbage collector run, which looks in vain at what an import makes: it takes a tenth of its time.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    pressed = []

    def note(number: int, frame: FrameType | None) -> None:
        pressed.append(number)

    previous = signal.signal(signal.SIGINT, note)
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()
        signal.signal(signal.SIGINT, signal.SIG_DFL if previous is None else previous)
    if pressed:
        raise KeyboardInterrupt
