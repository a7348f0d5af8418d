"""Actions that set and forget launch configurations, and keep them within a scope."""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping
from typing import Any

from ..action import Action
from ..frontend import Entity, Parser, expose_action
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_types import SomeSubstitutionsType
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._setting import Setting, Unsetting


@expose_action("let")
class SetLaunchConfiguration(Setting):
    """Gives a launch configuration a value."""

    def kept_in(self, context: LaunchContext) -> MutableMapping[str, str]:
        """In the context's `launch_configurations`."""
        return context.launch_configurations


@expose_action("unset")
class UnsetLaunchConfiguration(Unsetting):
    """Forgets a launch configuration."""

    def kept_in(self, context: LaunchContext) -> MutableMapping[str, str]:
        """In the context's `launch_configurations`."""
        return context.launch_configurations


class PushLaunchConfigurations(Action):
    """Begins a scope: what is set from here on is forgotten at the matching pop."""

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Begin it."""
        context._push_launch_configurations()
        return None


class PopLaunchConfigurations(Action):
    """Ends a scope."""

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """End it."""
        context._pop_launch_configurations()
        return None


@expose_action("reset")
class ResetLaunchConfigurations(Action):
    """Forgets all launch configurations but the given ones."""

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__kept = dict(launch_configurations or {})

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments; each `keep` names a configuration with its value."""
        _, kwargs = super().parse(entity, parser)
        kwargs["launch_configurations"] = kept(entity, parser)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Forget them."""
        kept = {
            perform_substitutions(context, normalize_to_list_of_substitutions(name)): perform_substitutions(
                context, normalize_to_list_of_substitutions(value)
            )
            for name, value in self.__kept.items()
        }
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)
        return None


def kept(entity: Entity, parser: Parser) -> dict[Any, Any]:
    """The names and values of the `keep` tags in a tag."""
    found = {}
    for keep in entity.get_attr("keep", data_type=list[Entity], optional=True) or []:
        name = tuple(parser.parse_substitution(keep.get_attr("name")))
        found[name] = parser.parse_substitution(keep.get_attr("value"))
        keep.assert_entity_completely_parsed()
    return found
