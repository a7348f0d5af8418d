"""What must not be left half done: Ctrl-C waits until it is over.

An import that is interrupted leaves a package behind that can never be imported again in this kernel: some of its
modules are there and know a package that is gone. (matplotlib's first import takes a second: long enough to be hit.)
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Put off SIGINT to the end of the block, where it raises KeyboardInterrupt. In another thread: does nothing."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    pressed = []

    def note(number: int, frame: FrameType | None) -> None:
        pressed.append(number)

    previous = signal.signal(signal.SIGINT, note)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.SIG_DFL if previous is None else previous)
    if pressed:
        raise KeyboardInterrupt
