"""`LaunchContext`, what a launch knows while it runs, with its events and their handlers."""

from __future__ import annotations

import os
from collections import defaultdict, deque
from collections.abc import Callable, Iterable
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from ._entities import LaunchDescriptionEntity, SomeEntitiesType, Substitution

if TYPE_CHECKING:
    from turtle_lesson.ros.launching.service import LaunchService


class Event:
    """Base of all events."""


Reaction = SomeEntitiesType | Callable[[Any, "LaunchContext"], SomeEntitiesType | None] | None


class EventHandler:
    """Gives entities when its event happens; launch's own handlers may instead call a function that gives them.

    One with `handle_once` is forgotten after the first event.
    """

    def __init__(
        self, *, matcher: Callable[[Event], bool], entities: Reaction = None, handle_once: bool = False
    ) -> None:
        self.__matcher = matcher
        self.handle_once = handle_once
        self.__function = entities if callable(entities) else None
        self.entities: list[LaunchDescriptionEntity] = [] if callable(entities) else as_entities(entities)
        """What is visited when the event happens, as far as it is known."""

    def matches(self, event: Event) -> bool:
        """Whether it is for this event."""
        return self.__matcher(event)

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Call the function, or give the entities."""
        context.extend_locals({"event": event})
        if self.handle_once:
            context.unregister_event_handler(self)
        return self.entities if self.__function is None else self.__function(event, context)


def as_entities(entities: SomeEntitiesType | None) -> list[LaunchDescriptionEntity]:
    """A list, whether one entity was given, several, or none."""
    if entities is None:
        return []
    if isinstance(entities, LaunchDescriptionEntity):
        return [entities]
    if isinstance(entities, Iterable):
        return list(entities)
    raise TypeError(f"expected an action or a list of actions, got {entities!r}")


class LaunchContext:
    """The state of one launch: its configurations, and the environment variables as it sees them."""

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False) -> None:
        self.argv = list(argv or [])
        self.noninteractive = noninteractive
        self.is_shutdown = False
        self.launch_configurations: dict[str, Any] = {}
        self.environment = dict(os.environ)
        self._scopes: defaultdict[str, list[dict[str, Any]]] = defaultdict(list)
        self._host: LaunchService
        """What carries the launch out; a context in which substitutions are merely performed has none."""
        self._configurations_read: set[str] = set()
        self._event_queue: deque[Event] = deque()
        self._event_handlers: deque[EventHandler] = deque()
        self._locals: dict[str, Any] = {}

    @property
    def locals(self) -> SimpleNamespace:
        """Names that handlers and includes set, such as `event` and `current_launch_file_path`."""
        return SimpleNamespace(**self._locals)

    def extend_locals(self, extensions: dict[str, Any]) -> None:
        """Set names until the current handler or include is done."""
        self._locals.update(extensions)

    def _push(self, *names: str) -> None:
        """Begin a scope of `launch_configurations`, `environment` or `_locals`."""
        for name in names:
            self._scopes[name].append(dict(getattr(self, name)))

    def _pop(self, *names: str) -> None:
        """End the scope: forget what was set in it."""
        for name in names:
            setattr(self, name, self._scopes[name].pop())

    def would_handle_event(self, event: Event) -> bool:
        """Whether anybody waits for such an event."""
        return any(handler.matches(event) for handler in self._event_handlers)

    def register_event_handler(self, event_handler: EventHandler) -> None:
        """Have events handled; a later handler goes first."""
        self._event_handlers.appendleft(event_handler)

    def unregister_event_handler(self, event_handler: EventHandler) -> None:
        """Take an event handler out."""
        self._event_handlers.remove(event_handler)

    def emit_event_sync(self, event: Event) -> None:
        """Queue an event; it is handled after what is being done now."""
        self._event_queue.append(event)
        self._host.settle_soon()

    def perform_substitution(self, substitution: Substitution) -> str:
        """The substitution's text in this context."""
        return substitution.perform(self)
