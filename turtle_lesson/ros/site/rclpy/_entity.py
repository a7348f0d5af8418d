"""What an executor waits for: timers, subscriptions, guard conditions, clients and services have this in common.

An entity *signals* its executor when work for it arrives, and is then looked at in the executor's next cycle. Nothing
is ever polled.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .callback_groups import CallbackGroup
from .exceptions import refuse_destroyed

if TYPE_CHECKING:
    from turtle_lesson.ros.trace import Callback

    from .executors import Executor
    from .node import Node

TIMER, SUBSCRIPTION, GUARD, CLIENT, SERVICE = range(5)


class Entity:
    """Base class. `_kind` decides the order in a cycle; `_number` is the order of creation."""

    _kind = GUARD
    _traced: Callback | None = None
    """Where its runs are noted, if the world keeps a trace of them."""

    def __init__(self, callback: Callable[..., Any] | None, callback_group: CallbackGroup | None) -> None:
        self.callback: Any = callback
        self.callback_group: Any = callback_group
        self._is_async = inspect.iscoroutinefunction(callback)
        self._executor: Executor | None = None
        self._node: Node | None = None
        self._listed_in: Executor | None = None
        self._turn = (0, 0, 0)
        self._number = 0
        self._destroyed = False
        if callback_group is not None:
            callback_group.add_entity(self)

    def _signal(self) -> None:
        """Tell the executor that there may be work."""
        executor = self._executor
        if executor is not None and self._listed_in is not executor:
            self._listed_in = executor
            executor._signalled.append(self)
            strand = executor._waiter
            if strand is not None and strand.parked:
                strand.parked = False
                executor._make_ready(strand)

    def _has_work(self) -> bool:
        """Whether there is work right now."""
        raise NotImplementedError

    def _take(self) -> tuple[Any, ...] | None:
        """Take one piece of work: the arguments of the callback, or None if there is nothing to call."""
        raise NotImplementedError

    def _done_with(self, arguments: tuple[Any, ...], result: Any) -> None:
        """The callback has returned `result`."""

    def _check_alive(self) -> None:
        if self._destroyed and self._node is not None:
            refuse_destroyed(self._node._ros_simulation)

    def destroy(self) -> None:
        """Never be called again."""
        self._destroyed = True
        self._executor = None
        if self.callback_group is not None:
            self.callback_group.entities.discard(self)

    @property
    def handle(self) -> Any:
        """The entity stands for itself: there is no C object beneath it."""
        return self
