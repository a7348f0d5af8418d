"""Loggers: lines such as `[INFO] [1800000012.300000000] [navigator]: text`, and `/rosout` messages.

A simulated process logs to its stderr, as a real one does. What a notebook cell itself logs goes to its stdout, as with
RCUTILS_LOGGING_USE_STDOUT=1 on a robot, because Jupyter shows stderr as if it were an error.
"""

from __future__ import annotations

import re
import sys
from datetime import UTC, datetime
from types import CodeType, FrameType
from typing import Any

from turtle_lesson.ros.distro import CHILD_LOGGERS_ON_ROSOUT
from turtle_lesson.ros.runtime.world import current_process, current_world
from turtle_lesson.ros.sim.errors import shown_path
from turtle_lesson.ros.sim.simulation import EPOCH, NANOSECONDS

from .._hints import did_you_mean
from .._state import RclpyState
from .logging_severity import LoggingSeverity


class RcutilsLogger:
    """A logger with a name; `get_child` makes one below it, which takes over its level."""

    _parent: str | None = None
    """The logger whose lines go to /rosout together with this one's, if this is a child since Iron."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self._sites: dict[tuple[CodeType, int], CallSite] = {}

    def get_child(self, name: str) -> RcutilsLogger:
        """The logger `<this>.<name>`. Since Iron its lines are published on /rosout, too, if this one's are."""
        if not name:
            raise ValueError("Child logger name must not be empty.")
        child = RcutilsLogger(self.name + "." + name if self.name else name)
        if current_world().release.has(CHILD_LOGGERS_ON_ROSOUT):
            child._parent = self._parent or self.name
        return child

    def set_level(self, level: int) -> None:
        """Print only what is at least this severe."""
        levels()[self.name] = LoggingSeverity(level)

    def get_effective_level(self) -> LoggingSeverity:
        """The level in force: this logger's, or that of the nearest one above it that has one."""
        return _effective_level(self.name)

    def is_enabled_for(self, severity: int) -> bool:
        """Whether a line of this severity would be printed."""
        return LoggingSeverity(severity) >= self.get_effective_level()

    def log(self, message: str, severity: int, name: str | None = None, **kwargs: Any) -> bool:
        """Log a line, under another name if one is given; False if it was held back."""
        if name is not None:
            kwargs["name"] = name
        return self._log(message, LoggingSeverity(severity), kwargs, sys._getframe(1))

    def debug(self, message: str, **kwargs: Any) -> bool:
        """Log a line that only its developer wants to see."""
        return self._log(message, LoggingSeverity.DEBUG, kwargs, sys._getframe(1))

    def info(self, message: str, **kwargs: Any) -> bool:
        """Log a line that says what happens."""
        return self._log(message, LoggingSeverity.INFO, kwargs, sys._getframe(1))

    def warning(self, message: str, **kwargs: Any) -> bool:
        """Log a line about something that may be wrong."""
        return self._log(message, LoggingSeverity.WARN, kwargs, sys._getframe(1))

    warn = warning

    def error(self, message: str, **kwargs: Any) -> bool:
        """Log a line about something that is wrong."""
        return self._log(message, LoggingSeverity.ERROR, kwargs, sys._getframe(1))

    def fatal(self, message: str, **kwargs: Any) -> bool:
        """Log a line about the end."""
        return self._log(message, LoggingSeverity.FATAL, kwargs, sys._getframe(1))

    def _log(self, message: str, severity: LoggingSeverity, options: dict[str, Any], frame: FrameType) -> bool:
        name = options.pop("name", self.name) if options else self.name
        if message is None:
            message = "(null)"  # what C makes of it
        elif not isinstance(message, str):
            raise TypeError(f"a log message must be a str, got {message!r}: write str(…) or an f-string")
        key = (frame.f_code, frame.f_lasti)  # in a cell each statement of a line has code of its own
        site = self._sites.get(key)
        if site is None:
            site = self._sites[key] = CallSite(severity, name, options)
        elif options != site.options or name != site.name or severity != site.severity:
            site.check(severity, name, options)
        if severity < _effective_level(name):
            return False
        now = current_world().sim.now
        if site.filters and not site.lets_through():
            return False
        own = current_process().state(RclpyState)
        goes_to = own.log_to
        if goes_to.get("stdout", True):
            text = _line(message, severity, name, EPOCH + now, frame, own.log_format)
            if own.log_colorized:
                text = f"{COLORS.get(severity.name, NORMAL)}{text}{NORMAL}"
            print(text, file=sys.stdout if current_process().is_notebook else sys.stderr)
        publish = own.rosout.get(name if self._parent is None else self._parent)
        if publish is not None and goes_to.get("rosout", True):
            publish(name, message, severity, frame)
        return True


def _effective_level(name: str) -> LoggingSeverity:
    """The level of the logger of this name, or that of the nearest one above it that has one."""
    known = levels()
    while name and known:
        level = known.get(name, LoggingSeverity.UNSET)
        if level != LoggingSeverity.UNSET:
            return level
        name = name.rpartition(".")[0]
    return known.get("", LoggingSeverity.INFO) or LoggingSeverity.INFO


def levels() -> dict[str, LoggingSeverity]:
    """The levels that were set in this process, by logger name; '' is the default."""
    return current_process().state(RclpyState).log_levels


# -- when a log call is held back: once, skip_first, throttle_duration_sec (the rules of rclpy's rcutils_logger.py) -----


FILTERS = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once")


def _filters_of(options: dict[str, Any]) -> dict[str, Any]:
    """The options of a log call that are set. Raises TypeError if they make no sense."""
    for name in options:
        if name not in FILTERS:
            hint = did_you_mean(name, FILTERS)
            raise TypeError(f'parameter "{name}" is not one of the recognized logging options "{list(FILTERS)}"{hint}')
    found = {name: options[name] for name in FILTERS if options.get(name)}
    pause, clock = found.get("throttle_duration_sec", 0), found.get("throttle_time_source_type")
    fits = clock is None or (hasattr(clock, "_now") and "throttle_duration_sec" in options)
    if not fits or not isinstance(pause, (int, float)):
        what = "throttle_duration_sec is a number of seconds, and throttle_time_source_type a clock such as node.get_clock()"
        raise TypeError(f"{what}, got {options!r}")
    return found


class CallSite:
    """What a logger remembers of one place in a program: the options of its call, and what its filters need to know."""

    __slots__ = ("filters", "last_time", "name", "options", "printed", "severity", "skipped")

    def __init__(self, severity: LoggingSeverity, name: str, options: dict[str, Any]) -> None:
        self.severity = severity
        self.name = name
        self.options = options
        self.filters = _filters_of(options)
        self.skipped = self.printed = False
        self.last_time: int | None = None
        """When it was last not held back by its throttle (ns)."""

    def check(self, severity: LoggingSeverity, name: str, options: dict[str, Any]) -> None:
        """Raise ValueError if the same line of a program is used in another way than before."""
        if (severity, name, _filters_of(options)) != (self.severity, self.name, self.filters):
            raise ValueError("Logger severity, name and filters cannot be changed between calls.")

    def lets_through(self) -> bool:
        """Whether this call is to be printed: the first filter that holds it back ends the question."""
        filters = self.filters
        if "throttle_duration_sec" in filters:
            clock = filters.get("throttle_time_source_type")
            now = current_world().sim.now if clock is None else clock._now()
            pause = filters["throttle_duration_sec"] * NANOSECONDS
            if self.last_time is not None and now < self.last_time + pause:
                return False
            self.last_time = now
        if "skip_first" in filters and not self.skipped:
            self.skipped = True
            return False
        if "once" in filters and self.printed:
            return False
        self.printed = True
        return True


NORMAL = "\033[0m"
COLORS = {"DEBUG": "\033[32m", "WARN": "\033[33m", "ERROR": "\033[31m", "FATAL": "\033[31m"}
"""Of lines that are not printed in the normal colour (rcutils' logging.c)."""


def _line(message: str, severity: LoggingSeverity, name: str, time: int, frame: FrameType, wanted: str | None) -> str:
    """A line of a time (ns since 1970) in the usual format, or in a wanted one such as `{severity} {name}: {message}`.

    What is no known word in braces stays as it is (https://docs.ros.org/en/humble/Concepts/Intermediate/About-Logging.html).
    """
    seconds, nanoseconds = divmod(time, NANOSECONDS)
    stamp = f"{seconds}.{nanoseconds:09d}"
    if wanted is None:
        return f"[{severity.name}] [{stamp}] [{name}]: {message}"
    path = shown_path(frame.f_code.co_filename)
    words = {
        "severity": severity.name,
        "name": name,
        "message": message,
        "function_name": frame.f_code.co_name,
        "file_name": path,
        "short_file_name": path.rpartition("/")[2],
        "line_number": frame.f_lineno,
        "time": stamp,
        "time_as_nanoseconds": time,
        "date_time_with_ms": f"{datetime.fromtimestamp(seconds, UTC):%Y-%m-%d %H:%M:%S}.{nanoseconds // 1_000_000:03d}",
    }
    text = re.sub(r"\{(\w+)\}", lambda found: str(words.get(found[1], found[0])), wanted)
    return text.replace("\\n", "\n").replace("\\t", "\t").replace("\\033", "\033")
