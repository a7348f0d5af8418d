"""`LaunchContext`: what a launch knows while it runs: configurations, environment, event handlers, events."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterable
from typing import Any

from ._host import Host
from .event import Event
from .event_handler import BaseEventHandler
from .substitution import Substitution


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
