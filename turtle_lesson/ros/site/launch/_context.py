"""`LaunchContext`, what a launch knows while it runs, with its events and their handlers."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, Protocol

from ._entities import LaunchDescriptionEntity, SomeEntitiesType, Substitution

if TYPE_CHECKING:
    from .actions._processes import ExecuteLocal


class Event:
    """Base of all events."""

    name = "launch.Event"


class BaseEventHandler:
    """Knows which events it is for. `handle_once` handlers are forgotten after the first."""

    def __init__(self, *, matcher: Callable[[Event], bool], handle_once: bool = False) -> None:
        self.__matcher = matcher
        self.__handle_once = handle_once

    @property
    def handle_once(self) -> bool:
        """Whether it handles one event only."""
        return self.__handle_once

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


class RosHelper(Protocol):
    """A node of launch's own, which listens to managed nodes and calls their services."""

    def watch(self, node_name: str, heard: Callable[[Any], None]) -> None:
        """Have a function called with each TransitionEvent of a node."""

    def change_state(self, node_name: str, transition_id: int, answered: Callable[[bool], None]) -> None:
        """Ask a node for a transition; the function is called with the answer."""


class Host(Protocol):
    """Starts the processes and keeps the time of a launch."""

    def next_process_number(self) -> int:
        """The number after the dash in `navigator-1`, counted from 1."""

    def start_process(self, action: ExecuteLocal) -> None:
        """Have the action's process started as soon as the description has been walked through."""

    def call_later(self, seconds: float, function: Callable[[], None]) -> None:
        """Have a function called after some robot time."""

    def settle_soon(self) -> None:
        """Have the waiting events handled, still at this instant."""

    def ros_helper(self) -> RosHelper:
        """The node of launch's own; it is made when it is first asked for."""


class Locals:
    """Read-only names with values, as `context.locals.event`."""

    def __init__(self, values: dict[str, Any]) -> None:
        self.__dict__.update(values)

    def __getattr__(self, name: str) -> Any:
        known = ", ".join(self.__dict__)
        raise AttributeError(f"context.locals does not contain attribute '{name}', it contains: [{known}]")

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"can't set attribute '{name}', locals are read-only")


class LaunchContext:
    """The state of one launch."""

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False) -> None:
        self.argv = list(argv or [])
        self.noninteractive = noninteractive
        self.is_shutdown = False
        self.asyncio_loop = None
        self._host: Host | None = None
        self._configurations_read: set[str] = set()
        self._output_override: str | None = None
        self._include_depth = 0
        self._event_queue: deque[Event] = deque()
        self._event_handlers: deque[BaseEventHandler] = deque()
        self._globals: dict[str, Any] = {}
        self._locals: dict[str, Any] = {}
        self._locals_stack: list[dict[str, Any]] = []
        self._launch_configurations: dict[str, Any] = {}
        self._launch_configurations_stack: list[dict[str, Any]] = []
        self._environment = dict(os.environ)
        self._environment_at_start = dict(os.environ)
        self._environment_stack: list[dict[str, str]] = []

    def _set_is_shutdown(self, state: bool) -> None:
        self.is_shutdown = state

    # -- names with values ------------------------------------------------------------------------------

    @property
    def locals(self) -> Locals:
        """Names that handlers and includes set, such as `event` and `current_launch_file_path`."""
        return Locals(self.get_locals_as_dict())

    def get_locals_as_dict(self) -> dict[str, Any]:
        """The same as a dictionary."""
        return {**self._globals, **self._locals}

    def extend_globals(self, extensions: dict[str, Any]) -> None:
        """Set names for good."""
        self._globals.update(extensions)

    def extend_locals(self, extensions: dict[str, Any]) -> None:
        """Set names until the current handler or include is done."""
        self._locals.update(extensions)

    def _push_locals(self) -> None:
        self._locals_stack.append(dict(self._locals))

    def _pop_locals(self) -> None:
        self._locals = self._locals_stack.pop()

    # -- launch configurations and environment ------------------------------------------------------------

    @property
    def launch_configurations(self) -> dict[str, Any]:
        """The launch configurations: arguments that were given or have a default, and what was set."""
        return self._launch_configurations

    def _push_launch_configurations(self) -> None:
        self._launch_configurations_stack.append(dict(self._launch_configurations))

    def _pop_launch_configurations(self) -> None:
        if not self._launch_configurations_stack:
            raise RuntimeError("launch_configurations stack unexpectedly empty")
        self._launch_configurations = self._launch_configurations_stack.pop()

    @property
    def environment(self) -> dict[str, str]:
        """The environment variables as this launch sees them; the kernel's own stay as they are."""
        return self._environment

    def _push_environment(self) -> None:
        self._environment_stack.append(dict(self._environment))

    def _pop_environment(self) -> None:
        if not self._environment_stack:
            raise RuntimeError("environment stack unexpectedly empty")
        self._environment = self._environment_stack.pop()

    def _reset_environment(self) -> None:
        self._environment = dict(self._environment_at_start)

    # -- events -----------------------------------------------------------------------------------------

    def would_handle_event(self, event: Event) -> bool:
        """Whether anybody waits for such an event."""
        return any(handler.matches(event) for handler in self._event_handlers)

    def register_event_handler(self, event_handler: BaseEventHandler, append: bool = False) -> None:
        """Have events handled; a later handler goes first, unless `append`."""
        if append:
            self._event_handlers.append(event_handler)
        else:
            self._event_handlers.appendleft(event_handler)

    def unregister_event_handler(self, event_handler: BaseEventHandler) -> None:
        """Take an event handler out."""
        self._event_handlers.remove(event_handler)

    def emit_event_sync(self, event: Event) -> None:
        """Queue an event; it is handled after what is being done now."""
        self._event_queue.append(event)
        if self._host is not None:
            self._host.settle_soon()

    async def emit_event(self, event: Event) -> None:
        """The same for a coroutine."""
        self.emit_event_sync(event)

    def perform_substitution(self, substitution: Substitution) -> str:
        """The substitution's text in this context."""
        return substitution.perform(self)
