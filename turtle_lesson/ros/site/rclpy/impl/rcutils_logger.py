"""Loggers: lines such as `[INFO] [1800000012.300000000] [navigator]: text`, and `/rosout` messages.

A simulated process logs to its stderr, as a real one does. What a notebook cell itself logs goes to its stdout, as with
RCUTILS_LOGGING_USE_STDOUT=1 on a robot, because Jupyter shows stderr as if it were an error.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import CodeType, FrameType
from typing import Any

from turtle_lesson.ros.core import EPOCH, NANOSECONDS
from turtle_lesson.ros.world import current_process, current_world

from .._mistakes import did_you_mean
from .._notebook import is_notebook
from .logging_severity import LoggingSeverity

TWO_OF_A_NAME = (
    "Publisher already registered for provided node name. If this is due to multiple nodes with the same name then all "
    "logs for that logger name will go out over the existing publisher. As soon as any node with that name is destructed "
    "it will unregister the publisher, preventing any further logs for that name from being published on the rosout topic."
)
OPTIONS = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once")


def filters_of(options: dict[str, Any]) -> dict[str, Any]:
    """The filters that the options of a log call ask for: once, skip_first, throttle (s). Raises TypeError."""
    for name in options:
        if name not in OPTIONS:
            hint = did_you_mean(name, OPTIONS)
            raise TypeError(f'parameter "{name}" is not one of the recognized logging options {OPTIONS}{hint}')
    pause = options.get("throttle_duration_sec")
    if pause is not None and not isinstance(pause, (int, float)):
        raise TypeError(f"throttle_duration_sec is a number of seconds, got {pause!r}")
    if pause is None and options.get("throttle_time_source_type"):
        raise TypeError("throttle_time_source_type needs throttle_duration_sec, a number of seconds, beside it")
    asked = {"throttle": pause, "skip_first": options.get("skip_first"), "once": options.get("once")}
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
        pause = filters.get("throttle")
        if pause:
            if self._last is not None and now < self._last + pause * NANOSECONDS:
                return False
            self._last = now
        if "skip_first" in filters and not self._skipped:
            self._skipped = True
            return False
        if "once" in filters and self._logged:
            return False
        self._logged = True
        return True


class RcutilsLogger:
    """A logger with a name; `get_child` makes one below it, which takes over its level."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self._sites: dict[tuple[CodeType, int], CallSite] = {}

    def get_child(self, name: str) -> RcutilsLogger:
        """The logger `<this>.<name>`."""
        if not name:
            raise ValueError("Child logger name must not be empty.")
        return RcutilsLogger(f"{self.name}.{name}" if self.name else name)

    def set_level(self, level: int) -> None:
        """Print only what is at least this severe."""
        _levels()[self.name] = as_severity(level)

    def get_effective_level(self) -> LoggingSeverity:
        """The level in force: this logger's, or that of the nearest one above it that has one."""
        return _effective_level(self.name)

    def is_enabled_for(self, severity: int) -> bool:
        """Whether a line of this severity would be printed."""
        return as_severity(severity) >= self.get_effective_level()

    def log(self, message: str, severity: int, **options: Any) -> bool:
        """Log a line; False if it was held back."""
        return self._log(message, as_severity(severity), options, sys._getframe(1))

    def debug(self, message: str, **options: Any) -> bool:
        """Log a line that only its developer wants to see."""
        return self._log(message, LoggingSeverity.DEBUG, options, sys._getframe(1))

    def info(self, message: str, **options: Any) -> bool:
        """Log a line that says what happens."""
        return self._log(message, LoggingSeverity.INFO, options, sys._getframe(1))

    def warning(self, message: str, **options: Any) -> bool:
        """Log a line about something that may be wrong."""
        return self._log(message, LoggingSeverity.WARN, options, sys._getframe(1))

    warn = warning

    def error(self, message: str, **options: Any) -> bool:
        """Log a line about something that is wrong."""
        return self._log(message, LoggingSeverity.ERROR, options, sys._getframe(1))

    def fatal(self, message: str, **options: Any) -> bool:
        """Log a line about the end."""
        return self._log(message, LoggingSeverity.FATAL, options, sys._getframe(1))

    def _log(self, message: str, severity: LoggingSeverity, options: dict[str, Any], frame: FrameType) -> bool:
        name = options.pop("name", self.name) if options else self.name
        if not isinstance(message, str):
            raise TypeError(f"a log message must be a str, got {message!r}: write str(…) or an f-string")
        filters = filters_of(options) if options else {}
        key = (frame.f_code, frame.f_lasti)  # in a cell each statement of a line has code of its own
        site = self._sites.get(key)
        if site is None:
            site = self._sites[key] = CallSite(severity, name, filters)
        else:
            site.check(severity, name, filters)
        if severity < _effective_level(name):
            return False
        now = current_world().sim.now
        if not site.lets_through(now):
            return False
        _print(message, severity, name, EPOCH + now)
        publish = current_process().locals.get("rclpy.rosout", {}).get(name)
        if publish is not None:
            publish(message, severity, frame)
        return True


def _print(message: str, severity: LoggingSeverity, name: str, time: int) -> None:
    seconds, nanoseconds = divmod(time, NANOSECONDS)
    stream = sys.stdout if is_notebook(current_process()) else sys.stderr
    print(f"[{severity.name}] [{seconds}.{nanoseconds:09d}] [{name}]: {message}", file=stream)


def as_severity(level: int) -> LoggingSeverity:
    """The severity of a number; ValueError for what is none."""
    try:
        return LoggingSeverity(level)
    except ValueError as error:
        names = ", ".join(severity.name for severity in LoggingSeverity)
        error.add_note(f"Levels are rclpy.logging.LoggingSeverity.DEBUG and its like: {names}.")
        raise


def _effective_level(name: str) -> LoggingSeverity:
    """The level of the logger of this name, or that of the nearest one above it that has one."""
    levels = _levels()
    while name and levels:
        level = levels.get(name, LoggingSeverity.UNSET)
        if level != LoggingSeverity.UNSET:
            return level
        name = name.rpartition(".")[0]
    return levels.get("", LoggingSeverity.INFO) or LoggingSeverity.INFO


def _levels() -> dict[str, LoggingSeverity]:
    """The levels that were set in this process, by logger name; '' is the default."""
    return current_process().locals.setdefault("rclpy.log_levels", {})


def publish_rosout(name: str, publish: Callable[[str, LoggingSeverity, FrameType], None] | None) -> None:
    """Have what the logger of this name prints published too, or (None) no longer.

    A process has one such publisher for a name. A second node of the name warns, and makes do with the first one's.
    """
    publishers = current_process().locals.setdefault("rclpy.rosout", {})
    if publish is None:
        publishers.pop(name, None)
    elif publishers.setdefault(name, publish) is not publish:
        RcutilsLogger("rcl.logging_rosout").warning(TWO_OF_A_NAME)
