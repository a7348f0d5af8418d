"""When a log call is held back: once, skip_first, throttle_duration_sec (the rules of rclpy's rcutils_logger.py)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.core import NANOSECONDS

from .._mistakes import did_you_mean
from .logging_severity import LoggingSeverity

if TYPE_CHECKING:
    from ..clock import Clock

OPTIONS = ["throttle_duration_sec", "throttle_time_source_type", "skip_first", "once"]


def filters_of(options: dict[str, Any]) -> dict[str, Any]:
    """The filters that the options of a log call ask for: once, skip_first, throttle (s and clock).

    Raises TypeError, and ValueError for a time source that is no clock.
    """
    for name in options:
        if name not in OPTIONS:
            hint = did_you_mean(name, OPTIONS)
            raise TypeError(f'parameter "{name}" is not one of the recognized logging options "{OPTIONS}"{hint}')
    pause, clock = options.get("throttle_duration_sec"), options.get("throttle_time_source_type")
    if pause is not None and not isinstance(pause, (int, float)):
        raise TypeError(f"throttle_duration_sec is a number of seconds, got {pause!r}")
    if not pause and clock:
        raise TypeError(
            'required parameter "throttle_duration_sec" not specified but is required for the the logging filter "throttle"'
        )
    if clock is not None and not hasattr(clock, "clock_type"):
        raise ValueError(
            f'Received throttle_time_source_type of "{clock}" is not a clock instance: hand over node.get_clock()'
        )
    asked = {
        "throttle": (pause, clock) if pause else None,
        "skip_first": options.get("skip_first"),
        "once": options.get("once"),
    }
    return {name: value for name, value in asked.items() if value}


class CallSite:
    """What a logger remembers of one place in a program, for once, skip_first and throttling."""

    def __init__(self, severity: LoggingSeverity, name: str, filters: dict[str, Any]) -> None:
        self.severity = severity
        self.name = name
        self.filters = filters
        self._skipped = False
        self._logged = False
        self._last: int | None = None

    def check(self, severity: LoggingSeverity, name: str, filters: dict[str, Any]) -> None:
        """Raise ValueError if the same line of a program is used in another way than before."""
        if severity != self.severity:
            raise ValueError("Logger severity cannot be changed between calls.")
        if name != self.name:
            raise ValueError("Logger name cannot be changed between calls.")
        if filters.keys() != self.filters.keys():
            raise ValueError("Requested logging filters cannot be changed between calls.")
        if filters != self.filters:
            raise ValueError("Logging filter parameters cannot be changed between calls.")

    def lets_through(self, now: int) -> bool:
        """Whether this call is to be printed: the filters are asked in rclpy's order, throttle, skip_first, once."""
        filters = self.filters
        if not filters:
            return True
        if "throttle" in filters and not self._is_time(now, *filters["throttle"]):
            return False
        if "skip_first" in filters and not self._skipped:
            self._skipped = True
            return False
        if "once" in filters and self._logged:
            return False
        self._logged = True
        return True

    def _is_time(self, now: int, pause: float, clock: Clock | None) -> bool:
        """Whether the pause (s) is over, by the clock that was named or by the simulation's `now` (ns)."""
        now = now if clock is None else clock._now()
        if self._last is not None and now < self._last + pause * NANOSECONDS:
            return False
        self._last = now
        return True
