"""Actions that print, emit events and react to them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, ClassVar

from .. import logging
from .._context import BaseEventHandler, Event, LaunchContext
from .._entities import Action, LaunchDescriptionEntity, SomeSubstitutionsType
from .._tags import plain, text
from ..events import Shutdown as ShutdownEvent
from ..events.process import ProcessExited
from ..frontend import Entity, Parser, expose_action
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions

__all__ = ["EmitEvent", "Log", "LogDebug", "LogError", "LogInfo", "LogWarning", "RegisterEventHandler", "Shutdown"]

LEVELS = {
    "CRITICAL": "critical", "FATAL": "critical", "ERROR": "error", "WARNING": "warning", "WARN": "warning", "INFO": "info",
    "DEBUG": "debug",
}  # fmt: skip
"""The names of levels, and the logger's method for each."""


@expose_action("log")
class Log(Action):
    """Prints `[LEVEL] [launch.user]: …`. Debug lines are dropped, as at launch's default verbosity."""

    _tag: ClassVar = {
        "msg": text("message"),
        "level": lambda entity, parser: parser.parse_substitution(entity.get_attr("level", optional=True) or "INFO"),
    }

    def __init__(
        self,
        *,
        msg: SomeSubstitutionsType,
        level: SomeSubstitutionsType,
        logger_name: str = "launch.user",
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.msg = normalize_to_list_of_substitutions(msg)
        self.level = normalize_to_list_of_substitutions(level)
        self._logger_name = logger_name

    def execute(self, context: LaunchContext) -> None:
        """Print it. Raises KeyError if there is no such level."""
        level = perform_substitutions(context, self.level).upper()
        if level not in LEVELS:
            raise KeyError(f"Invalid log level '{level}', expected: {LEVELS.keys()}")
        method = getattr(logging.get_logger(self._logger_name), LEVELS[level])
        method(perform_substitutions(context, self.msg))


class _LogAt(Log):
    """Prints at the level that its name says."""

    _level: ClassVar[str]

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level=self._level, **kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser, ignore: Iterable[str] = ()) -> tuple[type, dict[str, Any]]:
        """As `Log`, without the level."""
        entity.get_attr("level", optional=True)
        return super().parse(entity, parser, [*(ignore or ()), "level"])


@expose_action("log_info")
class LogInfo(_LogAt):
    """Prints `[INFO] [launch.user]: …`."""

    _level = "INFO"


@expose_action("log_warning")
class LogWarning(_LogAt):
    """Prints `[WARNING] [launch.user]: …`."""

    _level = "WARNING"


@expose_action("log_error")
class LogError(_LogAt):
    """Prints `[ERROR] [launch.user]: …`."""

    _level = "ERROR"


@expose_action("log_debug")
class LogDebug(_LogAt):
    """Prints nothing, as a debug line at launch's default verbosity."""

    _level = "DEBUG"


class EmitEvent(Action):
    """Emits an event."""

    def __init__(self, *, event: Event, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not isinstance(event, Event):
            error = RuntimeError(f"EmitEvent() expected an event instance, got '{event}'.")
            error.add_note("Events are in launch.events; put an action such as Shutdown() directly into the list.")
            raise error
        self.event = event

    def execute(self, context: LaunchContext) -> None:
        """Emit it."""
        context.emit_event_sync(self.event)


@expose_action("shutdown")
class Shutdown(EmitEvent):
    """Ends all processes of the launch; as a node's `on_exit` it makes that node required."""

    _tag: ClassVar = {"reason": plain("reason", optional=True)}

    def __init__(self, *, reason: str = "reason not given", **kwargs: Any) -> None:
        super().__init__(event=ShutdownEvent(reason=reason), **kwargs)

    def execute(self, context: LaunchContext) -> None:
        """Begin to end it."""
        event = context.get_locals_as_dict().get("event")
        if isinstance(event, ProcessExited):
            text = f"process[{event.process_name}] was required: shutting down launched system"
            logging.get_logger().info(text)
        super().execute(context)


class RegisterEventHandler(Action):
    """Has an event handler react from here on."""

    def __init__(self, event_handler: BaseEventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not isinstance(event_handler, BaseEventHandler):
            what = f"RegisterEventHandler expected an event handler, got {event_handler!r}"
            raise TypeError(f"{what}; write RegisterEventHandler(OnProcessExit(target_action=…, on_exit=…))")
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        """Register it."""
        context.register_event_handler(self.event_handler)

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """What the handler will give."""
        return [self.event_handler.describe()]
