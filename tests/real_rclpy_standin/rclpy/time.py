"""A moment in time."""

from __future__ import annotations

from builtin_interfaces.msg import Time as TimeMessage


class Time:
    def __init__(self, *, nanoseconds: int = 0) -> None:
        self.nanoseconds = nanoseconds

    def to_msg(self) -> TimeMessage:
        return TimeMessage(sec=self.nanoseconds // 10**9, nanosec=self.nanoseconds % 10**9)
