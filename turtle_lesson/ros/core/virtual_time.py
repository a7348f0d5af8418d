"""`time.time()`, `time.sleep()` and their kin mean virtual time inside a simulated process, and only there.

The functions of the standard `time` module are replaced by ones that look at what is running: a strand of a simulated
process gets virtual time, everybody else (Jupyter, the event loop, other threads) gets the real one.
"""

from __future__ import annotations

import atexit
import threading
import time
from collections.abc import Callable
from typing import Any

from .simulation import CLOCK_READ, EPOCH, NANOSECONDS
from .strand import Strand, getcurrent

real_time = time.time
real_sleep = time.sleep
real_monotonic = time.monotonic


def _seconds(real: Callable[[], float], origin: int) -> Callable[[], float]:
    def read() -> float:
        strand = getcurrent()
        if type(strand) is Strand:
            return (origin + strand.simulation.read_clock()) / NANOSECONDS
        return real()

    return read


def _nanoseconds(real: Callable[[], int], origin: int) -> Callable[[], int]:
    def read() -> int:
        strand = getcurrent()
        if type(strand) is Strand:
            return origin + strand.simulation.read_clock()
        return real()

    return read


def _sleep(seconds: float) -> None:
    """Like time.sleep: in a simulated process it holds up this strand alone, in virtual time."""
    strand = getcurrent()
    if type(strand) is not Strand:
        real_sleep(seconds)
        return
    if seconds < 0:
        raise ValueError("sleep length must be non-negative")
    strand.simulation.sleep_until(strand.simulation.now + max(CLOCK_READ, round(seconds * NANOSECONDS)))


def _start_thread(real: Callable[[threading.Thread], None]) -> Callable[[threading.Thread], None]:
    def start(self: threading.Thread) -> None:
        if type(getcurrent()) is Strand:
            raise NotImplementedError(
                "a simulated process cannot start a thread in this classroom yet: a real thread would run beside "
                "virtual time. Use a timer, or a MultiThreadedExecutor, whose threads are simulated."
            )
        real(self)

    return start


_originals: dict[str, Any] = {}


def install() -> None:
    """Replace the functions of the standard `time` module; a second call does nothing."""
    if _originals:
        return
    replacements: dict[str, Any] = {
        "time": _seconds(time.time, EPOCH),
        "monotonic": _seconds(time.monotonic, 0),
        "perf_counter": _seconds(time.perf_counter, 0),
        "time_ns": _nanoseconds(time.time_ns, EPOCH),
        "monotonic_ns": _nanoseconds(time.monotonic_ns, 0),
        "perf_counter_ns": _nanoseconds(time.perf_counter_ns, 0),
        "sleep": _sleep,
    }
    for name, function in replacements.items():
        function.__name__ = function.__qualname__ = name
        function.__doc__ = getattr(time, name).__doc__
        _originals[name] = getattr(time, name)
        setattr(time, name, function)
    atexit.register(_restore)  # nothing may ask which greenlet runs while Python takes itself apart
    threading.Thread.start = _start_thread(threading.Thread.start)  # type: ignore[method-assign,assignment]


def _restore() -> None:
    """Python ends: the real functions are back, and who still holds one of ours gets real time from it."""
    global getcurrent
    getcurrent = _nothing
    for name, function in _originals.items():
        setattr(time, name, function)


def _nothing() -> None:
    """No strand runs any more."""
