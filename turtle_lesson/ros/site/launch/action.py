"""`Action`: an entity that does something, if its condition holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ._places import written_at
from .condition import Condition
from .launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class Action(LaunchDescriptionEntity):
    """Base of all actions. A subclass says in `execute` what it does."""

    _completes_later = False

    def __init__(self, *, condition: Condition | None = None) -> None:
        self.__condition = condition
        self._written_at = written_at()

    @property
    def condition(self) -> Condition | None:
        """The condition, or None."""
        return self.__condition

    def describe(self) -> str:
        """A short text that names it."""
        return f"{type(self).__name__}()"

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Carry it out if its condition holds."""
        if self.__condition is not None and not self.__condition.evaluate(context):
            return None
        entities = self.execute(context)
        if not self._completes_later:
            self._complete(context)
        return entities

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """What the action does; returns further entities to visit, or None."""
        return None

    def _complete(self, context: LaunchContext) -> None:
        """Tell whoever waits for it that the action is done."""
        from .events import ExecutionComplete

        event = ExecutionComplete(action=self)
        if context.would_handle_event(event):
            context.emit_event_sync(event)
