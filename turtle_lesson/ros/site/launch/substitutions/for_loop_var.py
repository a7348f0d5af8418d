"""`ForEachVar` and `ForLoopIndex`: what changes from round to round in a loop of an XML or YAML file."""

from __future__ import annotations

from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._parsing import arguments
from .substitution_failure import SubstitutionFailure


@expose_substitution("for-var")
class ForEachVar(Substitution):
    """Stands for a value of the current round of a ForEach."""

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        self._default = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(for-var `."""
        return cls, arguments("for-var", data, ["name", "default_value"], 1)

    @staticmethod
    def get_local_arg_name(name: str) -> str:
        """What the value is called among the context's locals."""
        return f"for_var_{name}"

    @property
    def name(self) -> list[Substitution]:
        """The value's name."""
        return self._name

    def describe(self) -> str:
        """Its name with the value's."""
        return f"{type(self).__name__}(name={' + '.join(piece.describe() for piece in self._name)})"

    def perform(self, context: LaunchContext) -> str:
        """The value, or the default.

        Raises:
            SubstitutionFailure: if it has neither.
        """
        name = perform_substitutions(context, self._name)
        values = context.get_locals_as_dict()
        if self.get_local_arg_name(name) in values:
            return str(values[self.get_local_arg_name(name)])
        if self._default is None:
            raise SubstitutionFailure(f"No default value provided for for-loop variable '{name}' and no value for it")
        return perform_substitutions(context, self._default)


@expose_substitution("index")
class ForLoopIndex(ForEachVar):
    """Stands for the number of the current round of a ForLoop."""

    def __init__(self, name: SomeSubstitutionsType) -> None:
        super().__init__(name)

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its argument as it stands behind `$(index `."""
        return cls, arguments("index", data, ["name"], 1)
