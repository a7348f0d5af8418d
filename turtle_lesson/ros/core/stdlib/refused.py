"""What a simulated process cannot have: other processes of the real computer, which would run beside virtual time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..strand import Strand, getcurrent

INSTEAD = "Threads can be used (threading, concurrent.futures.ThreadPoolExecutor), and further nodes by a launch file."
SIGNALS = "signal.signal, signal.alarm, signal.pause and signal.raise_signal are"


def processes(what: str) -> Callable[..., Any]:
    """A function that does what the real one does, but refuses a simulated process another process."""
    return _refusing(
        f"{what} is not possible here: another process of the computer would know nothing about the simulation "
        f"and its time. {INSTEAD}"
    )


def signals(what: str) -> Callable[..., Any]:
    """The same for what only a real operating system can do with signals."""
    return _refusing(f"{what} is not available here; {SIGNALS}")


def _refusing(sentence: str) -> Callable[..., Any]:
    def refused(real: Any, *arguments: Any, **keywords: Any) -> Any:
        if type(getcurrent()) is Strand:
            raise NotImplementedError(sentence)
        return real(*arguments, **keywords)

    return refused


def start_process(real: Any) -> Any:
    """`multiprocessing.Process.start`, which is what all of multiprocessing comes down to."""
    refused = processes("multiprocessing")

    def start(self: Any) -> None:
        refused(real, self)

    return start
