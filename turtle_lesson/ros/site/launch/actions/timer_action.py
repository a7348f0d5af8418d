"""`TimerAction`: do something after some robot time."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..action import Action
from ..event_handler import EventHandler
from ..event_handlers import OnShutdown
from ..events import TimerEvent
from ..frontend import Entity, Parser, expose_action
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_types import SomeSubstitutionsType
from ..utilities import ensure_argument_type, normalize_to_list_of_substitutions, perform_substitutions


@expose_action("timer")
class TimerAction(Action):
    """Gives its actions when `period` seconds have passed, once, unless it is cancelled before."""

    _completes_later = True

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[LaunchDescriptionEntity],
        cancel_on_shutdown: bool | SomeSubstitutionsType = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        ensure_argument_type(actions, Iterable, "actions", "TimerAction")
        self.__period = normalize_to_list_of_substitutions(str(period) if isinstance(period, int | float) else period)
        self.__actions = list(actions)
        self.__cancel_on_shutdown = str(cancel_on_shutdown).lower() not in {"false", "0"}
        self.__cancelled = False
        self.__locals: dict[str, Any] = {}

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `period`, `cancel_on_shutdown` and the actions in it."""
        _, kwargs = super().parse(entity, parser)
        kwargs["period"] = parser.parse_if_substitutions(entity.get_attr("period", data_type=float, can_be_str=True))
        cancel = entity.get_attr("cancel_on_shutdown", data_type=bool, optional=True, can_be_str=True)
        if cancel is not None:
            kwargs["cancel_on_shutdown"] = parser.parse_if_substitutions(cancel)
        kwargs["actions"] = [parser.parse_action(child) for child in entity.children]
        return cls, kwargs

    @property
    def period(self) -> Any:
        """The time to wait, as substitutions."""
        return self.__period

    @property
    def actions(self) -> list[LaunchDescriptionEntity]:
        """What it gives."""
        return self.__actions

    def describe_conditional_sub_entities(
        self,
    ) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """What it gives when its time is over."""
        seconds = " + ".join(part.describe() for part in self.__period)
        return [(f"{seconds} seconds pass without being canceled", self.__actions)]

    def cancel(self) -> None:
        """Do not do it after all."""
        self.__cancelled = True

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Begin to wait."""
        if self.__cancelled or context._host is None:
            return None
        seconds = float(perform_substitutions(context, self.__period))
        self.__locals = context.get_locals_as_dict()
        if self.__cancel_on_shutdown:
            context.register_event_handler(OnShutdown(on_shutdown=lambda event, context: self.cancel()))
        context._host.call_later(seconds, lambda: self._time_is_over(context))
        return None

    def _time_is_over(self, context: LaunchContext) -> None:
        if not self.__cancelled:
            handler = EventHandler(matcher=self._is_mine, entities=self.__actions, handle_once=True)
            context.register_event_handler(handler)
            context.emit_event_sync(TimerEvent(timer_action=self))
            self._complete(context)

    def _is_mine(self, event: object) -> bool:
        return isinstance(event, TimerEvent) and event.timer_action is self
