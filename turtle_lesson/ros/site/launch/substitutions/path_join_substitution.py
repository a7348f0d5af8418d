"""`PathJoinSubstitution`: parts of a path, joined."""

from __future__ import annotations

import os
from collections.abc import Iterable

from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


class PathJoinSubstitution(Substitution):
    """Joins its parts with the system's separator; a part may itself be a list of pieces."""

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType]) -> None:
        self.__parts = [normalize_to_list_of_substitutions(part) for part in substitutions]

    @property
    def substitutions(self) -> list[list[Substitution]]:
        """The parts, each a list of pieces."""
        return self.__parts

    def describe(self) -> str:
        """The parts in words."""
        parts = [" + ".join(piece.describe() for piece in part) for part in self.__parts]
        return f"PathJoin({', '.join(parts)})"

    def perform(self, context: LaunchContext) -> str:
        """The path."""
        return os.path.join(*[perform_substitutions(context, part) for part in self.__parts])
