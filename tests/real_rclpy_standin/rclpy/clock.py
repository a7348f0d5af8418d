"""The system's clock."""

from __future__ import annotations

import time

from builtin_interfaces.msg import Time as TimeMessage


class Time:
    def __init__(self, nanoseconds: int) -> None:
        self.nanoseconds = nanoseconds

    def to_msg(self) -> TimeMessage:
        return TimeMessage(sec=self.nanoseconds // 10**9, nanosec=self.nanoseconds % 10**9)


class Clock:
    def now(self) -> Time:
        return Time(time.time_ns())
