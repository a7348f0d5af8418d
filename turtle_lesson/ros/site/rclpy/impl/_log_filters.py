"""When a log call is held back: once, skip_first, throttle_duration_sec (the rules of rclpy's rcutils_logger.py).

What a filter needs to remember of one place in a program it keeps in that place's context, a dict.
"""

from __future__ import annotations

from typing import Any

from turtle_lesson.ros.core import NANOSECONDS
from turtle_lesson.ros.world import current_world

from .._mistakes import did_you_mean
from .logging_severity import LoggingSeverity

Context = dict[str, Any]


class _WorldTime:
    """The clock that throttling goes by where no other is named: the robot's time."""

    def now(self) -> Any:
        """The time as an rclpy.time.Time."""
        from ..clock import Clock

        return Clock().now()

    def _now(self) -> int:
        return current_world().sim.now


class LoggingFilter:
    """Base class. `params` are the options of a log call that ask for the filter, and what they are if they are left
    out; None for those that have to be given."""

    params: dict[str, Any] = {}  # noqa: RUF012

    @classmethod
    def initialize_context(cls, context: Context, **kwargs: Any) -> None:
        """Get the context of a place ready, at its first call. Raises TypeError for an option that is missing."""
        for param, default in cls.params.items():
            context[param] = kwargs.get(param, default)
            if context[param] is None:
                raise TypeError(f'Required parameter "{param}" was not specified for logging filter "{cls.__name__}"')

    @staticmethod
    def should_log(context: Context) -> bool:
        """Whether this call is to be printed; notes in the context what has to be known at the next one."""
        return True


class Once(LoggingFilter):
    """Prints the first call only."""

    params = {"once": None}  # noqa: RUF012

    @classmethod
    def initialize_context(cls, context: Context, **kwargs: Any) -> None:
        """See LoggingFilter."""
        super().initialize_context(context, **kwargs)
        context["has_been_logged_once"] = False

    @staticmethod
    def should_log(context: Context) -> bool:
        """See LoggingFilter."""
        first = not context["has_been_logged_once"]
        context["has_been_logged_once"] = True
        return first


class SkipFirst(LoggingFilter):
    """Prints all calls but the first."""

    params = {"skip_first": None}  # noqa: RUF012

    @classmethod
    def initialize_context(cls, context: Context, **kwargs: Any) -> None:
        """See LoggingFilter."""
        super().initialize_context(context, **kwargs)
        context["first_has_been_skipped"] = False

    @staticmethod
    def should_log(context: Context) -> bool:
        """See LoggingFilter."""
        skipped: bool = context["first_has_been_skipped"]
        context["first_has_been_skipped"] = True
        return skipped


class Throttle(LoggingFilter):
    """Prints a call only if the last one that was printed is `throttle_duration_sec` ago, by a clock."""

    params = {"throttle_duration_sec": None, "throttle_time_source_type": _WorldTime()}  # noqa: RUF012

    @classmethod
    def initialize_context(cls, context: Context, **kwargs: Any) -> None:
        """See LoggingFilter. Raises ValueError for a time source that is no clock."""
        super().initialize_context(context, **kwargs)
        pause, clock = context["throttle_duration_sec"], context["throttle_time_source_type"]
        if not isinstance(pause, (int, float)):
            raise TypeError(f"throttle_duration_sec is a number of seconds, got {pause!r}")
        if not hasattr(clock, "_now"):
            raise ValueError(
                f'Received throttle_time_source_type of "{clock}" is not a clock instance: hand over node.get_clock()'
            )
        context["throttle_last_logged"] = None

    @staticmethod
    def should_log(context: Context) -> bool:
        """See LoggingFilter."""
        now = context["throttle_time_source_type"]._now()
        last = context["throttle_last_logged"]
        if last is not None and now < last + context["throttle_duration_sec"] * NANOSECONDS:
            return False
        context["throttle_last_logged"] = now
        return True


supported_filters: dict[str, type[LoggingFilter]] = {"throttle": Throttle, "skip_first": SkipFirst, "once": Once}
"""All filters, in the order in which they are asked. A program may add one of its own."""


def get_filters_from_kwargs(**kwargs: Any) -> list[str]:
    """The filters that the options of a log call ask for, in the order of `supported_filters`.

    Raises TypeError for an option that is missing, or that there is not.
    """
    found = [name for name, each in supported_filters.items() if any(kwargs.get(param) for param in each.params)]
    for name in found:
        for param, default in supported_filters[name].params.items():
            if default is None and param not in kwargs:
                raise TypeError(
                    f'required parameter "{param}" not specified but is required for the the logging filter "{name}"'
                )
    known = [param for each in supported_filters.values() for param in each.params]
    for param in kwargs:
        if param not in known:
            hint = did_you_mean(param, known)
            raise TypeError(f'parameter "{param}" is not one of the recognized logging options "{known}"{hint}')
    return found


class CallSite:
    """What a logger remembers of one place in a program: its line, and the context of its filters."""

    __slots__ = ("context", "filters", "line", "name", "options", "severity")

    def __init__(self, severity: LoggingSeverity, name: str, options: Context, line: int) -> None:
        self.severity = severity
        self.name = name
        self.options = options
        self.line = line
        self.filters = get_filters_from_kwargs(**options) if options else []
        self.context: Context = {"name": name, "severity": severity}
        for each in self.filters:
            supported_filters[each].initialize_context(self.context, **options)
        self.context["filters"] = self.filters

    def check(self, severity: LoggingSeverity, name: str, options: Context) -> None:
        """Raise ValueError if the same line of a program is used in another way than before."""
        filters = get_filters_from_kwargs(**options)
        if severity != self.severity:
            raise ValueError("Logger severity cannot be changed between calls.")
        if name != self.name:
            raise ValueError("Logger name cannot be changed between calls.")
        if filters != self.filters:
            raise ValueError("Requested logging filters cannot be changed between calls.")
        for each in filters:
            params = supported_filters[each].params
            if any(self.context[param] != options.get(param, default) for param, default in params.items()):
                raise ValueError("Logging filter parameters cannot be changed between calls.")

    def lets_through(self) -> bool:
        """Whether this call is to be printed: no filter that is asked, one after the other, holds it back."""
        for each in self.filters:  # noqa: SIM110 (all() takes twice as long)
            if not supported_filters[each].should_log(self.context):
                return False
        return True
