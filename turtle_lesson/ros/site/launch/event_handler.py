"""`EventHandler`: what is to be done when something happens."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from .event import Event
from .launch_description_entity import LaunchDescriptionEntity
from .some_types import SomeEntitiesType

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class BaseEventHandler:
    """Knows which events it is for. `handle_once` handlers are forgotten after the first."""

    def __init__(self, *, matcher: Callable[[Event], bool], handle_once: bool = False) -> None:
        self.__matcher = matcher
        self.__handle_once = handle_once

    @property
    def handle_once(self) -> bool:
        """Whether it handles one event only."""
        return self.__handle_once

    @property
    def handler_description(self) -> str:
        """What it does, in words."""
        return ""

    @property
    def matcher_description(self) -> str:
        """What it waits for, in words."""
        return ""

    def matches(self, event: Event) -> bool:
        """Whether it is for this event."""
        return self.__matcher(event)

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """In words, and the entities that it gives as far as they are known."""
        return f"{type(self).__name__}()", []

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """React to the event; return entities to visit, or None."""
        context.extend_locals({"event": event})
        if self.handle_once:
            context.unregister_event_handler(self)
        return None


class EventHandler(BaseEventHandler):
    """Gives fixed entities when its event happens."""

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        entities: SomeEntitiesType | None = None,
        handle_once: bool = False,
    ) -> None:
        super().__init__(matcher=matcher, handle_once=handle_once)
        self.__entities = as_entities(entities)

    @property
    def entities(self) -> list[LaunchDescriptionEntity]:
        """What is visited when the event happens."""
        return self.__entities

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """In words, and the entities."""
        return f"{type(self).__name__}()", self.__entities

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Give the entities."""
        super().handle(event, context)
        return self.__entities


def as_entities(entities: SomeEntitiesType | None) -> list[LaunchDescriptionEntity]:
    """A list, whether one entity was given, several, or none."""
    if entities is None:
        return []
    if isinstance(entities, LaunchDescriptionEntity):
        return [entities]
    if isinstance(entities, Iterable):
        return list(entities)
    raise TypeError(f"expected an action or a list of actions, got {entities!r}")
