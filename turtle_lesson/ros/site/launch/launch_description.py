"""`LaunchDescription`: the list of what is to be started, and the arguments that it takes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from . import logging
from .launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from .action import Action
    from .actions import DeclareLaunchArgument, IncludeLaunchDescription
    from .launch_context import LaunchContext

    ArgumentWithIncludes = tuple[DeclareLaunchArgument, list[IncludeLaunchDescription] | None]


class LaunchDescription(LaunchDescriptionEntity):
    """What a launch file's `generate_launch_description()` returns."""

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self.__entities = list(initial_entities) if initial_entities is not None else []
        self.__deprecated_reason = deprecated_reason

    @property
    def entities(self) -> list[LaunchDescriptionEntity]:
        """Its entities, in order."""
        return self.__entities

    @property
    def deprecated(self) -> bool:
        """Whether its author says that it should not be used any more."""
        return self.__deprecated_reason is not None

    @property
    def deprecated_reason(self) -> str | None:
        """Why it should not be used any more, or None."""
        return self.__deprecated_reason

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        """Append an entity."""
        self.__entities.append(entity)

    def add_action(self, action: Action) -> None:
        """Append an action."""
        self.add_entity(action)

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Its entities."""
        return self.__entities

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Give its entities."""
        if self.__deprecated_reason is not None:
            path = context.get_locals_as_dict().get("current_launch_file_path")
            what = f"launch file [{path}] is deprecated" if path else "deprecated launch description"
            logging.get_logger().warning(f"{what}: {self.__deprecated_reason}")
        return self.__entities

    def get_launch_arguments(self, conditional_inclusion: bool = False) -> list[DeclareLaunchArgument]:
        """The arguments that it and what it includes declare."""
        found = self.get_launch_arguments_with_include_launch_description_actions(conditional_inclusion)
        return [argument for argument, _ in found]

    def get_launch_arguments_with_include_launch_description_actions(
        self, conditional_inclusion: bool = False
    ) -> list[ArgumentWithIncludes]:
        """Each declared argument, with the includes that lead to it (None at the top level)."""
        found: dict[str, ArgumentWithIncludes] = {}
        _collect(self.entities, conditional_inclusion, None, found)
        return list(found.values())


def _collect(
    entities: Iterable[LaunchDescriptionEntity],
    conditional: bool,
    includes: list[IncludeLaunchDescription] | None,
    found: dict[str, ArgumentWithIncludes],
) -> None:
    """Add the arguments declared in `entities` to `found`; the first declaration of a name counts."""
    from .actions import DeclareLaunchArgument, IncludeLaunchDescription, ResetLaunchConfigurations

    for entity in entities:
        if isinstance(entity, ResetLaunchConfigurations):
            return  # from here on, arguments given from outside are not seen any more
        if isinstance(entity, DeclareLaunchArgument) and entity.name not in found:
            entity._conditionally_included = conditional or entity.condition is not None
            found[entity.name] = (entity, includes)
        inner = includes
        below = entity.describe_sub_entities()
        if isinstance(entity, IncludeLaunchDescription):
            location = entity.launch_description_source.location
            if location in [outer.launch_description_source.location for outer in includes or []]:
                continue  # a file that includes itself takes no other arguments within itself
            inner = [*(includes or []), entity]
        _collect(below, conditional, inner, found)
        for _, group in entity.describe_conditional_sub_entities():
            _collect(group, True, inner, found)
