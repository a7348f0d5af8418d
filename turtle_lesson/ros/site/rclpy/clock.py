"""Clocks. All of them show virtual time: system and ROS time since 1970, steady time since the world's start."""

from __future__ import annotations

from turtle_lesson.ros.core import EPOCH
from turtle_lesson.ros.world import current_world

from ._blocking import drives_the_simulation
from .clock_type import ClockType
from .duration import Duration
from .time import Time

__all__ = ["Clock", "ClockType", "ROSClock"]


class Clock:
    """A clock of one kind; looking at it costs a microsecond of virtual time."""

    def __init__(self, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        self._clock_type = clock_type
        self._origin = 0 if clock_type == ClockType.STEADY_TIME else EPOCH
        self._simulation = current_world().sim

    @property
    def clock_type(self) -> ClockType:
        """Which kind of clock this is."""
        return self._clock_type

    def __repr__(self) -> str:
        return f"Clock(clock_type={self._clock_type.name})"

    def now(self) -> Time:
        """The time now."""
        return Time(nanoseconds=self._origin + self._simulation.read_clock(), clock_type=self._clock_type)

    @drives_the_simulation
    def sleep_until(self, until: Time, context: object = None) -> bool:
        """Hold up the caller until a time on this clock; True when it has come."""
        if until.clock_type != self._clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        self._simulation.sleep_until(max(self._simulation.now, until.nanoseconds - self._origin))
        return True

    @drives_the_simulation
    def sleep_for(self, rel_time: Duration, context: object = None) -> bool:
        """Hold up the caller for a duration; True when it is over."""
        self._simulation.sleep_until(self._simulation.now + max(0, rel_time.nanoseconds))
        return True


class ROSClock(Clock):
    """The clock of nodes."""

    def __init__(self) -> None:
        super().__init__(clock_type=ClockType.ROS_TIME)

    @property
    def ros_time_is_active(self) -> bool:
        """Whether a `/clock` topic rules this clock; here virtual time does."""
        return False
