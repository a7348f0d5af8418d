"""`time.time()`, `time.sleep()` and their kin mean virtual time inside a simulated process, and only there.

The functions of the standard `time` module are replaced by ones that look at what is running: a strand of a simulated
process gets virtual time, everybody else (Jupyter, the event loop, other threads) gets the real one.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from .patches import is_replaced, replace_function
from .simulation import CLOCK_READ, EPOCH, NANOSECONDS
from .strand import Strand, getcurrent

real_time = time.time
real_sleep = time.sleep
real_monotonic = time.monotonic


def _seconds(origin: int) -> Callable[..., float]:
    def read(real: Callable[[], float]) -> float:
        strand = getcurrent()
        if type(strand) is Strand:
            return (origin + strand.simulation.read_clock()) / NANOSECONDS
        return real()

    return read


def _nanoseconds(origin: int) -> Callable[..., int]:
    def read(real: Callable[[], int]) -> int:
        strand = getcurrent()
        if type(strand) is Strand:
            return origin + strand.simulation.read_clock()
        return real()

    return read


def never(seconds: float) -> bool:
    """Plain code sleeps in real time."""
    return False


sleeps_in_robot_time: Callable[[float], bool] = never
"""Asked when plain code wants to sleep: whether that was done in robot time, as a cell does that has started threads."""


def _sleep(real: Callable[[float], None], seconds: float, /) -> None:
    """Like time.sleep: in a simulated process it holds up this strand alone, in virtual time."""
    strand = getcurrent()
    if type(strand) is not Strand:
        if not sleeps_in_robot_time(seconds):
            real(seconds)
        return
    if seconds < 0:
        raise ValueError("sleep length must be non-negative")
    strand.simulation.sleep_until(strand.simulation.now + max(CLOCK_READ, round(seconds * NANOSECONDS)))


def install() -> None:
    """Replace the functions of the standard `time` module; a second call does nothing."""
    if is_replaced(time, "sleep"):
        return
    replacements: dict[str, Any] = {
        "time": _seconds(EPOCH),
        "monotonic": _seconds(0),
        "perf_counter": _seconds(0),
        "time_ns": _nanoseconds(EPOCH),
        "monotonic_ns": _nanoseconds(0),
        "perf_counter_ns": _nanoseconds(0),
        "sleep": _sleep,
    }
    for name, function in replacements.items():
        replace_function(time, name, function)
