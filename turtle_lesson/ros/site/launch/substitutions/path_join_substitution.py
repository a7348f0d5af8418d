"""`PathJoinSubstitution` and `PathSubstitution`: parts of a path, joined."""

from __future__ import annotations

import os
from collections.abc import Iterable

from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


class PathSubstitution(Substitution):
    """A path, to which `/` adds further parts: `PathSubstitution(FindPackageShare('p')) / 'launch' / 'x.py'`."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        self.__path = normalize_to_list_of_substitutions(path)

    @property
    def path(self) -> list[Substitution]:
        """The pieces of the path."""
        return self.__path

    def __truediv__(self, additional_path: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, additional_path])

    def describe(self) -> str:
        """The pieces in words."""
        return f"Path({' + '.join(piece.describe() for piece in self.__path)})"

    def perform(self, context: LaunchContext) -> str:
        """The path."""
        return perform_substitutions(context, self.__path)


class PathJoinSubstitution(Substitution):
    """Joins its parts with the system's separator; a part may itself be a list of pieces, and `/` adds one."""

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType]) -> None:
        self.__parts = [normalize_to_list_of_substitutions(part) for part in substitutions]

    @property
    def substitutions(self) -> list[list[Substitution]]:
        """The parts, each a list of pieces."""
        return self.__parts

    def __truediv__(self, additional_path: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self.__parts, additional_path])

    def describe(self) -> str:
        """The parts in words."""
        parts = [" + ".join(piece.describe() for piece in part) for part in self.__parts]
        return f"PathJoin({', '.join(parts)})"

    def perform(self, context: LaunchContext) -> str:
        """The path."""
        return os.path.join(*[perform_substitutions(context, part) for part in self.__parts])
