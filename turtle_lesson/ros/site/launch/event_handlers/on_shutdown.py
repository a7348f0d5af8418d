"""`OnShutdown`: what to do when the launch ends."""

from __future__ import annotations

from typing import Any

from ..event import Event
from ..event_handler import BaseEventHandler, as_entities
from ..events import Shutdown
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_types import SomeEntitiesType
from .on_action_event_base import Reaction


class OnShutdown(BaseEventHandler):
    """Reacts to the end of the launch."""

    def __init__(self, *, on_shutdown: Reaction, **kwargs: Any) -> None:
        super().__init__(matcher=lambda event: isinstance(event, Shutdown), **kwargs)
        self.__reaction = on_shutdown
        self.__entities = [] if callable(on_shutdown) else as_entities(on_shutdown)

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """In words, and the entities as far as they are known."""
        return "OnShutdown()", self.__entities

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Call the function, or give the entities."""
        super().handle(event, context)
        if callable(self.__reaction):
            return self.__reaction(event, context)
        return self.__entities
