"""`LaunchConfiguration`: the value of a launch argument."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._parsing import arguments
from .substitution_failure import SubstitutionFailure


@expose_substitution("var")
class LaunchConfiguration(Substitution):
    """Stands for the launch argument or configuration of a name."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(var `."""
        return cls, arguments("var", data, ["variable_name", "default"], 1)

    def __init__(
        self,
        variable_name: SomeSubstitutionsType,
        *,
        default: Any | Iterable[Any] | None = None,
    ) -> None:
        self.__variable_name = normalize_to_list_of_substitutions(variable_name)
        self.__default = None if default is None else normalize_to_list_of_substitutions(_texts(default))

    @property
    def variable_name(self) -> list[Substitution]:
        """The name."""
        return self.__variable_name

    def describe(self) -> str:
        """As in `LaunchConfig('rate')`."""
        return f"LaunchConfig({' + '.join(part.describe() for part in self.variable_name)})"

    def perform(self, context: LaunchContext) -> str:
        """The value, or the default.

        Raises:
            SubstitutionFailure: if it has neither.
        """
        name = perform_substitutions(context, self.variable_name)
        context._configurations_read.add(name)
        if name in context.launch_configurations:
            return str(context.launch_configurations[name])
        if self.__default is None:
            raise SubstitutionFailure(f"launch configuration '{name}' does not exist", _hint(name, context))
        return perform_substitutions(context, self.__default)


def _texts(default: Any) -> Any:
    """The default's parts as text, since any value may be given."""
    if isinstance(default, str | Substitution):
        return default
    if isinstance(default, Iterable):
        return [part if isinstance(part, str | Substitution) else str(part) for part in default]
    return str(default)


def _hint(name: str, context: LaunchContext) -> str:
    import difflib

    close = difflib.get_close_matches(name, list(context.launch_configurations), n=1)
    if close:
        return f"Did you mean LaunchConfiguration('{close[0]}')?"
    return (
        f"Before its first use put DeclareLaunchArgument('{name}', default_value='…'), "
        f'in XML <arg name="{name}" default="…"/>.'
    )
