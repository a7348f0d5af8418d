"""Callback groups: which callbacks may run beside each other."""

from __future__ import annotations

from collections.abc import Callable
from weakref import WeakSet


class CallbackGroup:
    """Base class. An executor asks `can_execute`, then `beginning_execution`, then calls `ending_execution`."""

    def __init__(self) -> None:
        self.entities: WeakSet[object] = WeakSet()

    def add_entity(self, entity: object) -> None:
        """Let something with a callback belong to this group."""
        self.entities.add(entity)

    def has_entity(self, entity: object) -> bool:
        """Whether something belongs to this group."""
        return entity in self.entities

    def can_execute(self, entity: object) -> bool:
        """Whether the callback may run now."""
        raise NotImplementedError

    def beginning_execution(self, entity: object) -> bool:
        """Note that the callback is about to run; False if it may not."""
        raise NotImplementedError

    def ending_execution(self, entity: object) -> None:
        """Note that the callback is done."""
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """All callbacks may run at once, even one of them several times."""

    def can_execute(self, entity: object) -> bool:
        """Always."""
        return True

    def beginning_execution(self, entity: object) -> bool:
        """Always."""
        return True

    def ending_execution(self, entity: object) -> None:
        """Nothing to note."""


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """One callback at a time. A coroutine keeps the group taken while it waits."""

    def __init__(self) -> None:
        super().__init__()
        self._active_entity: object = None

    def can_execute(self, entity: object) -> bool:
        """Whether no callback of the group runs or waits."""
        return self._active_entity is None

    def beginning_execution(self, entity: object) -> bool:
        """Take the group, if it is free."""
        if self._active_entity is None:
            self._active_entity = entity
            return True
        return False

    def ending_execution(self, entity: object) -> None:
        """Free the group."""
        self._active_entity = None


def begin_of(group: CallbackGroup) -> Callable[[object], bool]:
    """What an executor asks before it runs a callback of a group. It is settled once, when an entity is made.

    Groups of rclpy's own need one question, for theirs are the same two; a program's own group is asked both.
    """
    if type(group).can_execute in (ReentrantCallbackGroup.can_execute, MutuallyExclusiveCallbackGroup.can_execute):
        return group.beginning_execution
    return lambda entity: group.can_execute(entity) and group.beginning_execution(entity)
