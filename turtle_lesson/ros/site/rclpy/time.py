"""Points in time, each on the clock that it was read from."""

from __future__ import annotations

from datetime import datetime
from functools import total_ordering
from typing import Any

from .clock_type import ClockType
from .constants import S_TO_NS
from .duration import LIMIT, Duration, equals_no_other_thing


@total_ordering
class Time:
    """`Time(seconds=…, nanoseconds=…, clock_type=…)`: ns since the clock's beginning, never negative."""

    def __init__(
        self, *, seconds: float = 0, nanoseconds: float = 0, clock_type: ClockType = ClockType.SYSTEM_TIME
    ) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        if seconds < 0:
            raise ValueError("Seconds value must not be negative")
        if nanoseconds < 0:
            raise ValueError("Nanoseconds value must not be negative")
        total = int(seconds * S_TO_NS) + int(nanoseconds)
        if total >= LIMIT:
            raise OverflowError("Total nanoseconds value is too large to store in C time point.")
        self._nanoseconds = total
        self._clock_type = clock_type

    @property
    def clock_type(self) -> ClockType:
        """The kind of clock that this time is of."""
        return self._clock_type

    @property
    def nanoseconds(self) -> int:
        """The time in ns."""
        return self._nanoseconds

    def seconds_nanoseconds(self) -> tuple[int, int]:
        """Whole seconds, and the rest in ns."""
        return divmod(self._nanoseconds, S_TO_NS)

    def to_msg(self) -> Any:
        """As builtin_interfaces/msg/Time."""
        from builtin_interfaces.msg import Time as Message

        seconds, nanoseconds = self.seconds_nanoseconds()
        return Message(sec=seconds, nanosec=nanoseconds)

    def to_datetime(self) -> datetime:
        """As a date and time of day, in the computer's time zone. Raises TypeError for steady time, which has none."""
        if self.clock_type not in (ClockType.ROS_TIME, ClockType.SYSTEM_TIME):
            raise TypeError("Time object's clock type should be either ROS_TIME or SYSTEM_TIME")
        return datetime.fromtimestamp(self._nanoseconds / S_TO_NS)

    @classmethod
    def from_msg(cls, msg: Any, clock_type: ClockType = ClockType.ROS_TIME) -> Time:
        """From builtin_interfaces/msg/Time, which does not say which clock it is from: ROS time unless told."""
        from builtin_interfaces.msg import Time as Message

        if not isinstance(msg, Message):
            raise TypeError(f"Must pass a builtin_interfaces.msg.Time object, got {msg!r}")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec, clock_type=clock_type)

    def __repr__(self) -> str:
        return f"Time(nanoseconds={self._nanoseconds}, clock_type={self.clock_type.name})"

    def __add__(self, other: object) -> Time:
        if isinstance(other, Duration):
            return Time(nanoseconds=self._nanoseconds + other.nanoseconds, clock_type=self.clock_type)
        return NotImplemented

    __radd__ = __add__

    def __sub__(self, other: object) -> Any:
        if isinstance(other, Time):
            self._check(other, "Can't subtract times with different clock types")
            return Duration(nanoseconds=self._nanoseconds - other._nanoseconds)
        if isinstance(other, Duration):
            if other.nanoseconds > self._nanoseconds:
                raise ValueError("Subtraction leads to negative time.")
            return Time(nanoseconds=self._nanoseconds - other.nanoseconds, clock_type=self.clock_type)
        return NotImplemented

    def _check(self, other: Time, complaint: str = "Can't compare times with different clock types") -> None:
        if self.clock_type != other.clock_type:
            raise TypeError(complaint)

    def __eq__(self, other: object) -> bool:
        """Whether it is the same time. Raises TypeError for another clock's and, until Iron, for what is no time."""
        if not isinstance(other, Time):
            return equals_no_other_thing("time", other)
        self._check(other)
        return self._nanoseconds == other._nanoseconds

    __hash__ = None  # type: ignore[assignment]

    def __lt__(self, other: object) -> bool:
        if not isinstance(other, Time):
            return NotImplemented
        self._check(other)
        return self._nanoseconds < other._nanoseconds
