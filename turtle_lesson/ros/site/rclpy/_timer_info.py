"""`TimerInfo`, which a timer's callback may ask for (rclpy of Jazzy and newer)."""

from __future__ import annotations

from .clock_type import ClockType
from .time import Time


class TimerInfo:
    """When a timer's callback should have been called, and when it is."""

    __module__ = "rclpy.timer"

    def __init__(
        self,
        *,
        expected_call_time: int = 0,
        actual_call_time: int = 0,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
    ) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        if expected_call_time < 0 or actual_call_time < 0:
            raise ValueError("call time values must not be negative")
        self._expected_call_time = Time(nanoseconds=expected_call_time, clock_type=clock_type)
        self._actual_call_time = Time(nanoseconds=actual_call_time, clock_type=clock_type)

    def __repr__(self) -> str:
        return f"<TimerInfo, expected {self._expected_call_time}, actual {self._actual_call_time}>"

    @property
    def expected_call_time(self) -> Time:
        """When the tick was due."""
        return self._expected_call_time

    @property
    def actual_call_time(self) -> Time:
        """When the callback was called."""
        return self._actual_call_time
