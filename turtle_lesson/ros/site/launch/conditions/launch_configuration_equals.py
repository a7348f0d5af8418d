"""`LaunchConfigurationEquals` and its opposite: comparing a launch argument's value."""

from __future__ import annotations

from ..condition import Condition
from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


class LaunchConfigurationEquals(Condition):
    """Holds if the launch configuration has this value; for None, if it is not set at all."""

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        super().__init__(predicate=self._holds)
        self.__name = launch_configuration_name
        self.__expected = None if expected_value is None else normalize_to_list_of_substitutions(expected_value)

    def _holds(self, context: LaunchContext) -> bool:
        context._configurations_read.add(self.__name)
        value = context.launch_configurations.get(self.__name)
        if self.__expected is None or value is None:
            return self.__expected is None and value is None
        return bool(value == perform_substitutions(context, self.__expected))


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """Holds if the launch configuration has another value; for None, if it is set."""

    def _holds(self, context: LaunchContext) -> bool:
        return not super()._holds(context)
