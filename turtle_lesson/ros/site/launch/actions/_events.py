"""Actions that print, emit events and react to them."""

from __future__ import annotations

from typing import Any, ClassVar

from .. import logging
from .._context import Event, EventHandler, LaunchContext
from .._entities import Action, LaunchDescriptionEntity, SomeSubstitutionsType, explained, text_of
from .._entities import normalize_to_list_of_substitutions as pieces
from ..events import Shutdown as ShutdownEvent
from ..events.process import ProcessExited
from ..frontend import attribute, expose_action, plain

__all__ = ["EmitEvent", "LogInfo", "RegisterEventHandler", "Shutdown"]


@expose_action("log")
@expose_action("log_info")
class LogInfo(Action):
    """Prints `[INFO] [launch.user]: …`."""

    _tag: ClassVar = {"msg": attribute("message")}

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.msg = pieces(msg)

    def execute(self, context: LaunchContext) -> None:
        """Print it."""
        logging.get_logger("launch.user").info(text_of(context, self.msg))


class EmitEvent(Action):
    """Emits an event."""

    def __init__(self, *, event: Event, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not isinstance(event, Event):
            error = RuntimeError(f"EmitEvent() expected an event instance, got '{event}'.")
            raise explained(error, "Events are in launch.events; an action such as Shutdown() needs no EmitEvent.")
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
        event = context._locals.get("event")
        if isinstance(event, ProcessExited):
            text = f"process[{event.process_name}] was required: shutting down launched system"
            logging.get_logger().info(text)
        super().execute(context)


class RegisterEventHandler(Action):
    """Has an event handler react from here on."""

    def __init__(self, event_handler: EventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not isinstance(event_handler, EventHandler):
            what = f"RegisterEventHandler expected an event handler, got {event_handler!r}"
            raise TypeError(f"{what}; write RegisterEventHandler(OnProcessExit(target_action=…, on_exit=…))")
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        """Register it."""
        context.register_event_handler(self.event_handler)

    def describe_conditional_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """What the handler will give."""
        return self.event_handler.entities
