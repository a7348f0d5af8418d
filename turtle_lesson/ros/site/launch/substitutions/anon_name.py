"""`AnonName`: a name that nobody else has."""

from __future__ import annotations

from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._parsing import arguments


@expose_substitution("anon")
class AnonName(Substitution):
    """The given name with a number behind it; the same name gives the same one within a launch.

    The real one puts the machine, the process and random digits there; here it is the same in every run.
    """

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(anon `."""
        return cls, arguments("anon", data, ["name"], 1)

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self.__name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The first part of the name."""
        return self.__name

    def describe(self) -> str:
        """As in `AnonName('talker')`."""
        return f"AnonName({' + '.join(part.describe() for part in self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """The name."""
        name = perform_substitutions(context, self.name)
        known = context.launch_configurations
        numbers = [key for key in known if key.startswith("anon")]
        return str(known.setdefault(f"anon{name}", f"{name}_{len(numbers) + 1}"))
