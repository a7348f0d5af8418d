"""Actions that print, emit events and react to them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from .. import logging
from .._context import BaseEventHandler, Event, LaunchContext
from .._entities import Action, LaunchDescriptionEntity, SomeSubstitutionsType, Substitution
from ..events import Shutdown as ShutdownEvent
from ..events.process import ProcessExited
from ..frontend import Entity, Parser, expose_action
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions

LEVELS = {
    "CRITICAL": "critical",
    "FATAL": "critical",
    "ERROR": "error",
    "WARNING": "warning",
    "WARN": "warning",
    "INFO": "info",
    "DEBUG": "debug",
}
"""The names of levels, and the logger's method for each."""


@expose_action("log")
class Log(Action):
    """Prints `[LEVEL] [launch.user]: …`. Debug lines are dropped, as at launch's default verbosity."""

    def __init__(
        self,
        *,
        msg: SomeSubstitutionsType,
        level: SomeSubstitutionsType,
        logger_name: str = "launch.user",
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__msg = normalize_to_list_of_substitutions(msg)
        self.__level = normalize_to_list_of_substitutions(level)
        self.__logger_name = logger_name

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `message` (and `level`, where it has no level of its own)."""
        _, kwargs = super().parse(entity, parser)
        kwargs["msg"] = parser.parse_substitution(entity.get_attr("message"))
        level = entity.get_attr("level", optional=True)
        if cls is Log:
            kwargs["level"] = parser.parse_substitution(level or "INFO")
        return cls, kwargs

    @property
    def msg(self) -> list[Substitution]:
        """The text's pieces."""
        return self.__msg

    @property
    def level(self) -> list[Substitution]:
        """The level's pieces."""
        return self.__level

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Print it.

        Raises:
            KeyError: if there is no such level.
        """
        level = perform_substitutions(context, self.level).upper()
        if level not in LEVELS:
            raise KeyError(f"Invalid log level '{level}', expected: {LEVELS.keys()}")
        method = getattr(logging.get_logger(self.__logger_name), LEVELS[level])
        method(perform_substitutions(context, self.msg))
        return None


@expose_action("log_info")
class LogInfo(Log):
    """Prints `[INFO] [launch.user]: …`."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="INFO", **kwargs)


@expose_action("log_warning")
class LogWarning(Log):
    """Prints `[WARNING] [launch.user]: …`."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="WARNING", **kwargs)


@expose_action("log_error")
class LogError(Log):
    """Prints `[ERROR] [launch.user]: …`."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="ERROR", **kwargs)


@expose_action("log_debug")
class LogDebug(Log):
    """Prints nothing, as a debug line at launch's default verbosity."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level="DEBUG", **kwargs)


class EmitEvent(Action):
    """Emits an event."""

    def __init__(self, *, event: Event, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not isinstance(event, Event):
            error = RuntimeError(f"EmitEvent() expected an event instance, got '{event}'.")
            error.add_note("Events are in launch.events; put an action such as Shutdown() directly into the list.")
            raise error
        self.__event = event

    @property
    def event(self) -> Event:
        """The event."""
        return self.__event

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Emit it."""
        context.emit_event_sync(self.event)
        return None


@expose_action("shutdown")
class Shutdown(EmitEvent):
    """Ends all processes of the launch; as a node's `on_exit` it makes that node required."""

    def __init__(self, *, reason: str = "reason not given", **kwargs: Any) -> None:
        super().__init__(event=ShutdownEvent(reason=reason), **kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its argument from `reason`."""
        _, kwargs = super().parse(entity, parser)
        reason = entity.get_attr("reason", optional=True)
        if reason is not None:
            kwargs["reason"] = parser.escape_characters(reason)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Begin to end it."""
        event = context.get_locals_as_dict().get("event")
        if isinstance(event, ProcessExited):
            text = f"process[{event.process_name}] was required: shutting down launched system"
            logging.get_logger().info(text)
        return super().execute(context)


class RegisterEventHandler(Action):
    """Has an event handler react from here on."""

    def __init__(self, event_handler: BaseEventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not isinstance(event_handler, BaseEventHandler):
            what = f"RegisterEventHandler expected an event handler, got {event_handler!r}"
            raise TypeError(f"{what}; write RegisterEventHandler(OnProcessExit(target_action=…, on_exit=…))")
        self.__event_handler = event_handler

    @property
    def event_handler(self) -> BaseEventHandler:
        """The handler."""
        return self.__event_handler

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Register it."""
        context.register_event_handler(self.event_handler)
        return None

    def describe_conditional_sub_entities(
        self,
    ) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """What the handler will give."""
        return [self.event_handler.describe()]
