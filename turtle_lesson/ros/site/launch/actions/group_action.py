"""`GroupAction`: several actions with one condition and a scope of their own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ..action import Action
from ..frontend import Entity, Parser, expose_action
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_types import SomeSubstitutionsType
from .environment import PopEnvironment, PushEnvironment, ResetEnvironment
from .launch_configurations import (
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
    kept,
)


@expose_action("group")
class GroupAction(Action):
    """Gives its actions; in a scope, what they set is forgotten at the end.

    Args:
        actions: what is in the group.
        scoped: whether it has a scope of its own.
        forwarding: whether the scope begins with what was set outside.
        launch_configurations: what is set at the beginning.
    """

    def __init__(
        self,
        actions: Iterable[Action],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        self.__actions = list(actions)
        self.__scoped = scoped
        self.__forwarding = forwarding
        self.__launch_configurations = dict(launch_configurations or {})

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from `scoped`, `forwarding`, nested `keep` tags and the actions in it."""
        _, kwargs = super().parse(entity, parser)
        for name in ("scoped", "forwarding"):
            value = entity.get_attr(name, data_type=bool, optional=True, can_be_str=False)
            if value is not None:
                kwargs[name] = value
        if configurations := kept(entity, parser):
            kwargs["launch_configurations"] = configurations
        kwargs["actions"] = [parser.parse_action(child) for child in entity.children if child.type_name != "keep"]
        return cls, kwargs

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """What it gives."""
        return self.get_sub_entities() if self.condition is None else []

    def describe_conditional_sub_entities(
        self,
    ) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """What it gives if its condition holds."""
        return [] if self.condition is None else [("if its condition holds", self.get_sub_entities())]

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Its actions, between those that begin and end the scope."""
        sets = [SetLaunchConfiguration(name, value) for name, value in self.__launch_configurations.items()]
        if not self.__scoped:
            return [*sets, *self.__actions]
        begin: list[LaunchDescriptionEntity] = [PushLaunchConfigurations(), PushEnvironment()]
        if self.__forwarding:
            begin += sets
        else:
            begin += [ResetEnvironment(), ResetLaunchConfigurations(self.__launch_configurations)]
        return [*begin, *self.__actions, PopEnvironment(), PopLaunchConfigurations()]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Give them."""
        return self.get_sub_entities()
