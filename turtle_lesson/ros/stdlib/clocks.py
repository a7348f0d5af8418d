"""`time` and `datetime` tell virtual time inside a simulated process, and only there.

Jupyter, the event loop and other threads get the real time. A robot's clock is in UTC here, whatever the computer's is, so that
a program prints the same text everywhere.
"""

from __future__ import annotations

import calendar
import copyreg
import datetime as real
import time
from collections.abc import Callable
from types import ModuleType
from typing import Any

from ..sim.simulation import EPOCH, NANOSECONDS
from ..sim.strand import Strand, running_strand

real_sleep = time.sleep
real_monotonic = time.monotonic


def _clock(origin: int, *, whole: bool = False) -> Callable[..., float]:
    """A clock that shows `origin` (ns) when a world starts, in s or as a whole number of ns."""

    def read(real: Callable[[], float]) -> float:
        strand = running_strand()
        if strand is None:
            return real()
        now = origin + strand.simulation.read_clock()
        return now if whole else now / NANOSECONDS

    return read


CLOCKS: dict[str, Callable[..., Any]] = {
    name + unit: _clock(EPOCH if name == "time" else 0, whole=unit == "_ns")
    for name in ("time", "monotonic", "perf_counter")
    for unit in ("", "_ns")
}
"""By name in `time`, the clocks; `time.sleep` is in `threads.py`."""


# -- time of day -------------------------------------------------------------------------------------------------------

_gmtime, _asctime, _strftime = time.gmtime, time.asctime, time.strftime


def _utc(strand: Strand, seconds: float | None = None, /) -> time.struct_time:
    return _gmtime(time.time() if seconds is None else seconds)


DATES: dict[str, Callable[..., Any]] = {
    "gmtime": _utc,
    "localtime": _utc,
    "asctime": lambda strand, moment=None, /: _asctime(_utc(strand) if moment is None else moment),
    "ctime": lambda strand, seconds=None, /: _asctime(_utc(strand, seconds)),
    "strftime": lambda strand, form, moment=None, /: _strftime(form, _utc(strand) if moment is None else moment),
    "mktime": lambda strand, moment, /: float(calendar.timegm(moment)),
}
"""By name in `time`, what tells the date in a simulated process."""


# -- dates -------------------------------------------------------------------------------------------------------------
# The real classes of `datetime` are made in C and cannot be changed. So the import statements of a program get a module
# with two classes derived from them; `isinstance(…, datetime)` gives the same answer for both. Moments without a time zone
# are taken for UTC, and not for the computer's. `today()` needs no change: it gives `time.time()` to `fromtimestamp`.

UTC = real.UTC


class _Date(type):
    """The type of both classes: objects of the real ones are theirs, too."""

    _behind: type

    def __instancecheck__(cls, instance: Any) -> bool:
        return cls.__subclasscheck__(type(instance))

    def __subclasscheck__(cls, subclass: type) -> bool:
        return issubclass(subclass, cls._behind) if "_behind" in vars(cls) else super().__subclasscheck__(subclass)


class date(real.date, metaclass=_Date):
    """A day."""

    _behind = real.date
    __module__ = "datetime"

    @classmethod
    def fromtimestamp(cls, timestamp: float, /) -> date:
        """The day at a number of seconds since 1970."""
        moment = real.datetime.fromtimestamp(timestamp, UTC)
        return cls(moment.year, moment.month, moment.day)


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
        """As `now()`."""
        return cls.fromtimestamp(time.time())

    @classmethod
    def fromtimestamp(cls, timestamp: float, tz: real.tzinfo | None = None) -> datetime:
        """The moment at a number of seconds since 1970."""
        moment = super().fromtimestamp(timestamp, UTC)
        return moment.replace(tzinfo=None) if tz is None else real.datetime.astimezone(moment, tz)

    def timestamp(self) -> float:
        """Seconds since 1970."""
        return real.datetime.timestamp(self if self.tzinfo is not None else self.replace(tzinfo=UTC))

    def astimezone(self, tz: real.tzinfo | None = None) -> datetime:
        """The same moment in another time zone."""
        moment = self if self.tzinfo is not None else self.replace(tzinfo=UTC)
        return real.datetime.astimezone(moment, UTC if tz is None else tz)


def _reduced(each: Any) -> tuple[Any, ...]:
    return type(each)._behind, each.__reduce_ex__(4)[1]


copyreg.pickle(date, _reduced)  # in a pickle they are of the real classes
copyreg.pickle(datetime, _reduced)


def make_module() -> ModuleType:
    """The module `datetime` that the programs' import statements get."""
    module = ModuleType("datetime", real.__doc__)
    module.__dict__.update({name: value for name, value in vars(real).items() if name != "__name__"})
    module.__dict__.update(date=date, datetime=datetime)
    return module
