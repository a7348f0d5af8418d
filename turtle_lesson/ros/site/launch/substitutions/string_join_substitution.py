"""`StringJoinSubstitution`: texts joined with something between them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


@expose_substitution("string-join")
class StringJoinSubstitution(Substitution):
    """Joins texts; a part may itself be a list of pieces."""

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType], delimiter: SomeSubstitutionsType = "") -> None:
        self.__parts = [normalize_to_list_of_substitutions(part) for part in substitutions]
        self.__delimiter = normalize_to_list_of_substitutions(delimiter)

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(string-join `: the delimiter, then the parts."""
        if len(data) < 2:
            what = "string-join substitution expects at least 2 arguments: 1 delimiter + at least 1 component"
            raise TypeError(what)
        return cls, {"delimiter": data[0], "substitutions": data[1:]}

    @property
    def substitutions(self) -> list[list[Substitution]]:
        """The parts, each a list of pieces."""
        return self.__parts

    @property
    def delimiter(self) -> list[Substitution]:
        """What stands between them."""
        return self.__delimiter

    def describe(self) -> str:
        """The parts in words."""
        return f"StringJoin({', '.join(' + '.join(piece.describe() for piece in part) for part in self.__parts)})"

    def perform(self, context: LaunchContext) -> str:
        """The text."""
        parts = [perform_substitutions(context, part) for part in self.__parts]
        return perform_substitutions(context, self.__delimiter).join(parts)
