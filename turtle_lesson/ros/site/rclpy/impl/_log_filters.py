"""When a log call is held back: once, skip_first, throttle_duration_sec (the rules of rclpy's rcutils_logger.py)."""

from __future__ import annotations

from typing import Any

from turtle_lesson.ros.runtime.world import current_world
from turtle_lesson.ros.sim.simulation import NANOSECONDS

from .._hints import did_you_mean
from .logging_severity import LoggingSeverity


class _WorldTime:
    """The clock that throttling goes by where no other is named: the robot's time."""

    def _now(self) -> int:
        return current_world().sim.now


OPTIONS: dict[str, dict[str, Any]] = {
    "throttle": {"throttle_duration_sec": None, "throttle_time_source_type": _WorldTime()},
    "skip_first": {"skip_first": None},
    "once": {"once": None},
}
"""The filters in the order in which they are asked, each with its options; None is the default of one that must be given."""


def filters_of(options: dict[str, Any]) -> list[str]:
    """The filters that the options of a log call ask for. Raises TypeError for an option that is missing or unknown."""
    found = [name for name, params in OPTIONS.items() if any(options.get(param) for param in params)]
    for name in found:
        for param, default in OPTIONS[name].items():
            if default is None and param not in options:
                raise TypeError(
                    f'required parameter "{param}" not specified but is required for the the logging filter "{name}"'
                )
    known = [param for params in OPTIONS.values() for param in params]
    for param in options:
        if param not in known:
            hint = did_you_mean(param, known)
            raise TypeError(f'parameter "{param}" is not one of the recognized logging options "{known}"{hint}')
    return found


class CallSite:
    """What a logger remembers of one place in a program: the options of its call, and what its filters need to know."""

    __slots__ = ("filters", "has_printed", "has_skipped", "last_printed", "name", "options", "severity", "values")

    def __init__(self, severity: LoggingSeverity, name: str, options: dict[str, Any]) -> None:
        self.severity = severity
        self.name = name
        self.options = options
        self.filters = filters_of(options) if options else []
        self.values = {
            param: options.get(param, default) for each in self.filters for param, default in OPTIONS[each].items()
        }
        self.has_printed = self.has_skipped = False
        self.last_printed: int | None = None
        if "throttle" in self.filters:
            pause, clock = self.values["throttle_duration_sec"], self.values["throttle_time_source_type"]
            if not isinstance(pause, (int, float)):
                raise TypeError(f"throttle_duration_sec is a number of seconds, got {pause!r}")
            if not hasattr(clock, "_now"):
                raise ValueError(
                    f'Received throttle_time_source_type of "{clock}" is not a clock instance: hand over node.get_clock()'
                )

    def check(self, severity: LoggingSeverity, name: str, options: dict[str, Any]) -> None:
        """Raise ValueError if the same line of a program is used in another way than before."""
        filters = filters_of(options)
        if severity != self.severity:
            raise ValueError("Logger severity cannot be changed between calls.")
        if name != self.name:
            raise ValueError("Logger name cannot be changed between calls.")
        if filters != self.filters:
            raise ValueError("Requested logging filters cannot be changed between calls.")
        defaults = {param: default for each in filters for param, default in OPTIONS[each].items()}
        if any(self.values[param] != options.get(param, default) for param, default in defaults.items()):
            raise ValueError("Logging filter parameters cannot be changed between calls.")

    def lets_through(self) -> bool:
        """Whether this call is to be printed: the first filter that holds it back ends the question."""
        for each in self.filters:
            if each == "throttle":
                now = self.values["throttle_time_source_type"]._now()
                pause = self.values["throttle_duration_sec"] * NANOSECONDS
                if self.last_printed is not None and now < self.last_printed + pause:
                    return False
                self.last_printed = now
            elif each == "skip_first":
                skipped, self.has_skipped = self.has_skipped, True
                if not skipped:
                    return False
            else:
                printed, self.has_printed = self.has_printed, True
                if printed:
                    return False
        return True
