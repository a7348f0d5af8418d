"""`Action`: an entity that does something, if its condition holds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._places import written_at
from .condition import Condition
from .launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from .frontend import Entity, Parser
    from .launch_context import LaunchContext


class Action(LaunchDescriptionEntity):
    """Base of all actions. A subclass says in `execute` what it does."""

    _completes_later = False

    def __init__(self, *, condition: Condition | None = None) -> None:
        self.__condition = condition
        self._written_at = written_at()

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """The class and its arguments for a tag of an XML or YAML file; here those that every action has.

        Raises:
            RuntimeError: if it has both `if` and `unless`.
        """
        from .conditions import IfCondition, UnlessCondition

        if_text = entity.get_attr("if", optional=True)
        unless_text = entity.get_attr("unless", optional=True)
        if if_text is not None and unless_text is not None:
            raise RuntimeError("if and unless conditions can't be used simultaneously")
        if if_text is not None:
            return cls, {"condition": IfCondition(parser.parse_substitution(if_text))}
        if unless_text is not None:
            return cls, {"condition": UnlessCondition(parser.parse_substitution(unless_text))}
        return cls, {}

    @property
    def condition(self) -> Condition | None:
        """The condition, or None."""
        return self.__condition

    def __repr__(self) -> str:
        return f"<{type(self).__module__}.{type(self).__qualname__} object>"

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
        """Tell the waiting callers that the action is done."""
        from .events import ExecutionComplete

        event = ExecutionComplete(action=self)
        if context.would_handle_event(event):
            context.emit_event_sync(event)
