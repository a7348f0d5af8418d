"""`time` and `datetime` tell virtual time inside a simulated process, and only there."""

from __future__ import annotations

import calendar
import datetime as real
import time
from collections.abc import Callable
from types import ModuleType
from typing import Any

from greenlet import getcurrent

from ..sim.simulation import EPOCH, NANOSECONDS
from ..sim.strand import Strand

# -- virtual time -------------------------------------------------------------------------------------------------
# `time.time()` and its kin mean virtual time inside a simulated process, and only there.
# The functions of the standard `time` module are replaced by ones that look at what is running: a strand of a
# simulated process gets virtual time, everybody else (Jupyter, the event loop, other threads) gets the real one.

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


CLOCKS: dict[str, Callable[..., Any]] = {
    "time": _seconds(EPOCH),
    "monotonic": _seconds(0),
    "perf_counter": _seconds(0),
    "time_ns": _nanoseconds(EPOCH),
    "monotonic_ns": _nanoseconds(0),
    "perf_counter_ns": _nanoseconds(0),
}
"""By name in `time`, the clocks; `time.sleep` is in `threads.py`."""


# -- time of day --------------------------------------------------------------------------------------------------
# The functions of `time` that tell the date: in a simulated process they tell the robot's.
# A robot's clock is in UTC here, whatever the computer's is, so that a program prints the same text everywhere.

_gmtime, _asctime = time.gmtime, time.asctime
_CLOCK_IDS = {getattr(time, name, None): name for name in ("CLOCK_REALTIME", "CLOCK_MONOTONIC")}


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
    if clk_id in _CLOCK_IDS and type(getcurrent()) is Strand:
        return time.time() if _CLOCK_IDS[clk_id] == "CLOCK_REALTIME" else time.monotonic()
    return real(clk_id)


def clock_gettime_ns(real: Callable[[int], int], clk_id: int, /) -> int:
    """What a clock of the system shows, in ns."""
    if clk_id in _CLOCK_IDS and type(getcurrent()) is Strand:
        return time.time_ns() if _CLOCK_IDS[clk_id] == "CLOCK_REALTIME" else time.monotonic_ns()
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


# -- dates --------------------------------------------------------------------------------------------------------
# The module `datetime` as simulated programs see it: `datetime.now()` and `date.today()` tell the robot's time.
# The real classes are made in C and cannot be changed. So the import statements of a program get a module with two
# classes derived from them; `isinstance(…, datetime)` gives the same answer for both. A robot's clock is in UTC:
# moments without a time zone are taken for that, and not for the computer's.

UTC = real.UTC


class _Date(type):
    """The type of both classes: objects of the real ones are theirs, too."""

    _behind: type

    def __instancecheck__(cls, instance: Any) -> bool:
        return isinstance(instance, cls._behind) if "_behind" in vars(cls) else super().__instancecheck__(instance)

    def __subclasscheck__(cls, subclass: type) -> bool:
        return issubclass(subclass, cls._behind) if "_behind" in vars(cls) else super().__subclasscheck__(subclass)


class date(real.date, metaclass=_Date):
    """A day."""

    _behind = real.date
    __module__ = "datetime"

    @classmethod
    def today(cls) -> date:
        """The robot's day."""
        return cls.fromtimestamp(time.time())

    @classmethod
    def fromtimestamp(cls, timestamp: float, /) -> date:
        """The day at a number of seconds since 1970."""
        moment = real.datetime.fromtimestamp(timestamp, UTC)
        return cls(moment.year, moment.month, moment.day)

    def __repr__(self) -> str:
        return f"datetime.{super().__repr__()}" if type(self) is date else super().__repr__()

    def __reduce_ex__(self, protocol: Any, /) -> Any:
        return _as_real(super().__reduce_ex__(protocol))


class datetime(real.datetime, metaclass=_Date):
    """A moment."""

    _behind = real.datetime
    __module__ = "datetime"

    @classmethod
    def now(cls, tz: real.tzinfo | None = None) -> datetime:
        """The robot's time, in a time zone, or in UTC and without naming it."""
        return cls.fromtimestamp(time.time(), tz)

    @classmethod
    def utcnow(cls) -> datetime:
        """The robot's time in UTC, without naming it."""
        return cls.fromtimestamp(time.time())

    @classmethod
    def today(cls) -> datetime:
        """As `now()`."""
        return cls.fromtimestamp(time.time())

    @classmethod
    def fromtimestamp(cls, timestamp: float, tz: real.tzinfo | None = None) -> datetime:
        """The moment at a number of seconds since 1970."""
        moment = super().fromtimestamp(timestamp, UTC)
        return moment.replace(tzinfo=None) if tz is None else real.datetime.astimezone(moment, tz)

    @classmethod
    def utcfromtimestamp(cls, timestamp: float, /) -> datetime:
        """The same, in UTC without naming it."""
        return cls.fromtimestamp(timestamp)

    def timestamp(self) -> float:
        """Seconds since 1970."""
        return real.datetime.timestamp(self if self.tzinfo is not None else self.replace(tzinfo=UTC))

    def astimezone(self, tz: real.tzinfo | None = None) -> datetime:
        """The same moment in another time zone."""
        moment = self if self.tzinfo is not None else self.replace(tzinfo=UTC)
        return real.datetime.astimezone(moment, UTC if tz is None else tz)

    def date(self) -> date:
        """Its day."""
        return date(self.year, self.month, self.day)

    def __repr__(self) -> str:
        return f"datetime.{super().__repr__()}" if type(self) is datetime else super().__repr__()

    def __reduce_ex__(self, protocol: Any, /) -> Any:
        return _as_real(super().__reduce_ex__(protocol))


def _as_real(reduced: Any) -> Any:
    """How an object is pickled and copied: as one of the real class, which everybody knows."""
    kind, *rest = reduced
    return (kind._behind if "_behind" in vars(kind) else kind, *rest)


def make_module() -> ModuleType:
    """The module that the programs' import statements get."""
    module = ModuleType("datetime", real.__doc__)
    module.__dict__.update({name: value for name, value in vars(real).items() if name != "__name__"})
    module.__dict__.update(date=date, datetime=datetime)
    return module
