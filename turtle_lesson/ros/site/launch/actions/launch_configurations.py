"""Actions that set and forget launch configurations, and keep them within a scope."""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping
from typing import Any

from ..action import Action
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_types import SomeSubstitutionsType
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._setting import Setting, Unsetting


class SetLaunchConfiguration(Setting):
    """Gives a launch configuration a value."""

    def kept_in(self, context: LaunchContext) -> MutableMapping[str, str]:
        """In the context's `launch_configurations`."""
        return context.launch_configurations


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


class ResetLaunchConfigurations(Action):
    """Forgets all launch configurations but the given ones."""

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__kept = dict(launch_configurations or {})

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
