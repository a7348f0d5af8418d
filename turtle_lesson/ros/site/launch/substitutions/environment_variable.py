"""`EnvironmentVariable`: the value of an environment variable."""

from __future__ import annotations

from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._parsing import arguments
from .substitution_failure import SubstitutionFailure


@expose_substitution("env")
class EnvironmentVariable(Substitution):
    """Stands for the environment variable of a name, as this launch sees it."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(env `."""
        return cls, arguments("env", data, ["name", "default_value"], 1)

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self.__name = normalize_to_list_of_substitutions(name)
        self.__default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    @property
    def name(self) -> list[Substitution]:
        """The variable's name."""
        return self.__name

    @property
    def default_value(self) -> list[Substitution] | None:
        """What counts if there is no such variable."""
        return self.__default_value

    def describe(self) -> str:
        """As in `EnvVar('HOME')`."""
        return f"EnvVar({' + '.join(part.describe() for part in self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """The value, or the default.

        Raises:
            SubstitutionFailure: if it has neither.
        """
        name = perform_substitutions(context, self.name)
        if name in context.environment:
            return context.environment[name]
        if self.default_value is None:
            hint = f"Give a default: EnvironmentVariable('{name}', default_value='…')."
            raise SubstitutionFailure(f"environment variable '{name}' does not exist", hint)
        return perform_substitutions(context, self.default_value)
