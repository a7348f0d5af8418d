"""`RegisterEventHandler`: begin to react to events."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..action import Action
from ..event_handler import BaseEventHandler
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity


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
