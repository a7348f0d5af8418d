"""`Shutdown`: end the whole launch."""

from __future__ import annotations

from typing import Any

from .. import logging
from ..events import Shutdown as ShutdownEvent
from ..events.process import ProcessExited
from ..frontend import Entity, Parser, expose_action
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from .emit_event import EmitEvent


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
