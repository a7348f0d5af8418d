"""The functions of `time` that tell the date: in a simulated process they tell the robot's.

A robot's clock is in UTC here, whatever the computer's is, so that a program prints the same text everywhere.
"""

from __future__ import annotations

import calendar
import time
from collections.abc import Callable
from typing import Any

from ..strand import Strand, getcurrent

_gmtime, _asctime = time.gmtime, time.asctime
_CLOCKS = {getattr(time, name, None): name for name in ("CLOCK_REALTIME", "CLOCK_MONOTONIC")}


def gmtime(real: Callable[..., Any], seconds: float | None = None, /) -> time.struct_time:
    """Seconds since 1970, or now, as date and time in UTC."""
    if seconds is None and type(getcurrent()) is Strand:
        seconds = time.time()
    return real(seconds)


def localtime(real: Callable[..., Any], seconds: float | None = None, /) -> time.struct_time:
    """Seconds since 1970, or now, as local date and time."""
    if type(getcurrent()) is Strand:
        return _gmtime(time.time() if seconds is None else seconds)
    return real(seconds)


def asctime(real: Callable[..., str], moment: Any = None, /) -> str:
    """Date and time, or now, as a text."""
    if moment is None and type(getcurrent()) is Strand:
        moment = _gmtime(time.time())
    return real() if moment is None else real(moment)


def ctime(real: Callable[..., str], seconds: float | None = None, /) -> str:
    """Seconds since 1970, or now, as a text in local time."""
    if type(getcurrent()) is Strand:
        return _asctime(_gmtime(time.time() if seconds is None else seconds))
    return real(seconds)


def strftime(real: Callable[..., str], form: str, moment: Any = None, /) -> str:
    """Date and time, or now, as a text of a given form."""
    if moment is None and type(getcurrent()) is Strand:
        moment = _gmtime(time.time())
    return real(form) if moment is None else real(form, moment)


def mktime(real: Callable[..., float], moment: Any, /) -> float:
    """The inverse of `localtime`."""
    return float(calendar.timegm(moment)) if type(getcurrent()) is Strand else real(moment)


def clock_gettime(real: Callable[[int], float], clk_id: int, /) -> float:
    """What a clock of the system shows, in s."""
    if clk_id in _CLOCKS and type(getcurrent()) is Strand:
        return time.time() if _CLOCKS[clk_id] == "CLOCK_REALTIME" else time.monotonic()
    return real(clk_id)


def clock_gettime_ns(real: Callable[[int], int], clk_id: int, /) -> int:
    """What a clock of the system shows, in ns."""
    if clk_id in _CLOCKS and type(getcurrent()) is Strand:
        return time.time_ns() if _CLOCKS[clk_id] == "CLOCK_REALTIME" else time.monotonic_ns()
    return real(clk_id)


REPLACEMENTS: tuple[Callable[..., Any], ...] = (
    gmtime,
    localtime,
    asctime,
    ctime,
    strftime,
    mktime,
    clock_gettime,
    clock_gettime_ns,
)
