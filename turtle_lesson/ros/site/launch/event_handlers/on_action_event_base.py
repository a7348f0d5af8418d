"""What the handlers of an action's events have in common."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..action import Action
from ..event import Event
from ..event_handler import BaseEventHandler, as_entities
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_types import SomeEntitiesType

Reaction = SomeEntitiesType | Callable[[Any, LaunchContext], SomeEntitiesType | None] | None
Target = Action | Callable[[Any], bool] | None


class OnActionEventBase(BaseEventHandler):
    """Reacts to one kind of event of one action, of those that a function picks, or of all."""

    def __init__(
        self, *, action_matcher: Target, on_event: Reaction, target_event_cls: type[Event], **kwargs: Any
    ) -> None:
        if not (action_matcher is None or callable(action_matcher) or isinstance(action_matcher, Action)):
            what = f"{type(self).__name__} requires an 'Action' or a callable as its target"
            raise TypeError(f"{what}, got {action_matcher!r}; write target_action=the_node")
        super().__init__(matcher=self._is_for, **kwargs)
        self.__target = action_matcher
        self.__event_class = target_event_cls
        self.__reaction = on_event
        self.__entities = [] if callable(on_event) else as_entities(on_event)

    @property
    def _target_action(self) -> Action | None:
        """The only action that it reacts to, if it was given one."""
        return self.__target if isinstance(self.__target, Action) else None

    def _is_for(self, event: Event) -> bool:
        if not isinstance(event, self.__event_class):
            return False
        action = getattr(event, "action", None)
        if self.__target is None or isinstance(self.__target, Action):
            return self.__target in (None, action)
        return self.__target(action)

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """In words, and the entities as far as they are known."""
        return f"{type(self).__name__}()", self.__entities

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Call the function, or give the entities."""
        super().handle(event, context)
        if callable(self.__reaction):
            return self.__reaction(event, context)
        return self.__entities
