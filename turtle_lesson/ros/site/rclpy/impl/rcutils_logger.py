"""Loggers: lines such as `[INFO] [1800000012.300000000] [navigator]: text`, and `/rosout` messages.

A simulated process logs to its stderr, as a real one does. What a notebook cell itself logs goes to its stdout, as with
RCUTILS_LOGGING_USE_STDOUT=1 on a robot, because Jupyter shows stderr as if it were an error.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import FrameType
from typing import Any

from turtle_lesson.ros.core import EPOCH, NANOSECONDS
from turtle_lesson.ros.world import current_process, current_world

from .logging_severity import LoggingSeverity

FEATURES = {"throttle_duration_sec", "throttle_time_source_type", "skip_first", "once"}


class CallSite:
    """What a logger remembers of one place in a program, for once, skip_first and throttling."""

    def __init__(self, severity: LoggingSeverity, features: dict[str, Any]) -> None:
        self.severity = severity
        self.features = features
        self._skip = bool(features.get("skip_first"))
        self._logged = False
        self._last: int | None = None

    def check(self, severity: LoggingSeverity, features: dict[str, Any]) -> None:
        """Raise ValueError if the same line of a program is used in another way than before."""
        if severity != self.severity:
            raise ValueError("Logger severity cannot be changed between calls.")
        if features.keys() != self.features.keys():
            raise ValueError("Requested logging filters cannot be changed between calls.")

    def lets_through(self, now: int) -> bool:
        """Whether this call is to be printed."""
        if self.features.get("once") and self._logged:
            return False
        throttle = self.features.get("throttle_duration_sec")
        if throttle is not None and self._last is not None and now - self._last < throttle * NANOSECONDS:
            return False
        self._last = now
        if self._skip:
            self._skip = False
            return False
        self._logged = True
        return True


class RcutilsLogger:
    """A logger with a name; `get_child` makes one below it, which takes over its level."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self._sites: dict[tuple[str, int, int], CallSite] = {}

    def get_child(self, name: str) -> RcutilsLogger:
        """The logger `<this>.<name>`."""
        if not name:
            raise ValueError("Child logger name must not be empty.")
        return RcutilsLogger(f"{self.name}.{name}" if self.name else name)

    def set_level(self, level: int) -> None:
        """Print only what is at least this severe."""
        _levels()[self.name] = LoggingSeverity(level)

    def get_effective_level(self) -> LoggingSeverity:
        """The level in force: this logger's, or that of the nearest one above it that has one."""
        levels = _levels()
        parts = self.name.split(".")
        for length in range(len(parts), 0, -1):
            level = levels.get(".".join(parts[:length]), LoggingSeverity.UNSET)
            if level != LoggingSeverity.UNSET:
                return level
        return levels.get("", LoggingSeverity.INFO)

    def is_enabled_for(self, severity: int) -> bool:
        """Whether a line of this severity would be printed."""
        return LoggingSeverity(severity) >= self.get_effective_level()

    def log(self, message: str, severity: int, **features: Any) -> bool:
        """Log a line; False if it was held back."""
        return self._log(message, LoggingSeverity(severity), features, sys._getframe(1))

    def debug(self, message: str, **features: Any) -> bool:
        """Log a line that only its developer wants to see."""
        return self._log(message, LoggingSeverity.DEBUG, features, sys._getframe(1))

    def info(self, message: str, **features: Any) -> bool:
        """Log a line that says what happens."""
        return self._log(message, LoggingSeverity.INFO, features, sys._getframe(1))

    def warning(self, message: str, **features: Any) -> bool:
        """Log a line about something that may be wrong."""
        return self._log(message, LoggingSeverity.WARN, features, sys._getframe(1))

    warn = warning

    def error(self, message: str, **features: Any) -> bool:
        """Log a line about something that is wrong."""
        return self._log(message, LoggingSeverity.ERROR, features, sys._getframe(1))

    def fatal(self, message: str, **features: Any) -> bool:
        """Log a line about the end."""
        return self._log(message, LoggingSeverity.FATAL, features, sys._getframe(1))

    def _log(self, message: str, severity: LoggingSeverity, features: dict[str, Any], frame: FrameType) -> bool:
        if features and not features.keys() <= FEATURES:
            unknown = ", ".join(sorted(features.keys() - FEATURES))
            raise TypeError(f"unexpected keyword argument {unknown}; a logger knows {', '.join(sorted(FEATURES))}")
        if not isinstance(message, str):
            raise TypeError(f"a log message must be a str, got {message!r}: write str(…) or an f-string")
        key = (frame.f_code.co_filename, frame.f_lineno, frame.f_lasti)
        site = self._sites.get(key)
        if site is None:
            site = self._sites[key] = CallSite(severity, features)
        else:
            site.check(severity, features)
        if severity < self.get_effective_level():
            return False
        world = current_world()
        if not site.lets_through(world.sim.now):
            return False
        self._print(message, severity, EPOCH + world.sim.now)
        publish = current_process().locals.get("rclpy.rosout", {}).get(self.name)
        if publish is not None:
            publish(message, severity, frame)
        return True

    def _print(self, message: str, severity: LoggingSeverity, time: int) -> None:
        seconds, nanoseconds = divmod(time, NANOSECONDS)
        stream = sys.stdout if current_process().name == "notebook" else sys.stderr
        print(f"[{severity.name}] [{seconds}.{nanoseconds:09d}] [{self.name}]: {message}", file=stream)


def _levels() -> dict[str, LoggingSeverity]:
    """The levels that were set in this process, by logger name; '' is the default."""
    return current_process().locals.setdefault("rclpy.log_levels", {})


def publish_rosout(name: str, publish: Callable[[str, LoggingSeverity, FrameType], None] | None) -> None:
    """Have what the logger of this name prints published too, or (None) no longer."""
    publishers = current_process().locals.setdefault("rclpy.rosout", {})
    if publish is None:
        publishers.pop(name, None)
    else:
        publishers.setdefault(name, publish)
