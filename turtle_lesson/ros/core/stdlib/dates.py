"""The module `datetime` as simulated programs see it: `datetime.now()` and `date.today()` tell the robot's time.

The real classes are made in C and cannot be changed. So the import statements of a program get a module with two
classes derived from them; `isinstance(…, datetime)` gives the same answer for both. A robot's
clock is in UTC: moments without a time zone are taken for that, and not for the computer's.
"""

from __future__ import annotations

import datetime as real
import time
from types import ModuleType
from typing import Any

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
