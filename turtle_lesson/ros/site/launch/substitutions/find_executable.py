"""`FindExecutable`: the path of a program on this computer."""

from __future__ import annotations

import shutil
from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._parsing import arguments
from .substitution_failure import SubstitutionFailure

PROGRAMS = {"ros2", "python3", "python", "xacro"}
"""Programs that the simulation itself has."""


@expose_substitution("find-exec")
class FindExecutable(Substitution):
    """Stands for the path at which a program is found."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(find-exec `."""
        return cls, arguments("find-exec", data, ["name"], 1)

    def __init__(self, *, name: SomeSubstitutionsType) -> None:
        self.__name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The program's name."""
        return self.__name

    def describe(self) -> str:
        """As in `FindExec('bash')`."""
        return f"FindExec({' + '.join(part.describe() for part in self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            SubstitutionFailure: if it is not on the PATH.
        """
        name = perform_substitutions(context, self.name)
        if name in PROGRAMS:
            return name
        path = shutil.which(name, path=context.environment.get("PATH"))
        if path is None:
            raise SubstitutionFailure(f"executable '{name}' not found on the PATH")
        return path
