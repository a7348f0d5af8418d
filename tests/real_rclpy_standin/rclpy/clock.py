"""The system's clock."""

from __future__ import annotations

import time

from .time import Time


class Clock:
    def now(self) -> Time:
        return Time(nanoseconds=time.time_ns())
