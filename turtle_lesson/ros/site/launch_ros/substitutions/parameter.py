"""`Parameter`: a parameter that `SetParameter` has given to all nodes."""

from __future__ import annotations

from typing import Any

from launch import LaunchContext
from launch.frontend import expose_substitution
from launch.some_types import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.substitutions import SubstitutionFailure
from launch.substitutions._parsing import arguments
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from .._values import parameters_in


@expose_substitution("param")
class Parameter(Substitution):
    """Stands for the value of a parameter that was set for all nodes."""

    def __init__(self, name: SomeSubstitutionsType, *, default: SomeSubstitutionsType | None = None) -> None:
        self.__name = normalize_to_list_of_substitutions(name)
        self.__default = None if default is None else normalize_to_list_of_substitutions(default)

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(param `."""
        return cls, arguments("param", data, ["name", "default"], 1)

    @property
    def name(self) -> list[Substitution]:
        """The parameter's name."""
        return self.__name

    def describe(self) -> str:
        """As in `Parameter('use_sim_time')`."""
        return f"Parameter({' + '.join(piece.describe() for piece in self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """The value as text, or the default.

        Raises:
            SubstitutionFailure: if it has neither.
        """
        name = perform_substitutions(context, self.name)
        for entry in reversed(context.launch_configurations.get("global_params", [])):
            for known, value in parameters_in(context, entry) if isinstance(entry, dict) else ():
                if known == name:
                    return str(value)
        if self.__default is None:
            hint = f"Put SetParameter('{name}', …) before it."
            raise SubstitutionFailure(f"parameter '{name}' not found", hint)
        return perform_substitutions(context, self.__default)
