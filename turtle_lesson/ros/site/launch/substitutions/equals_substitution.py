"""`EqualsSubstitution`, `NotEqualsSubstitution` and `IfElseSubstitution`: comparing texts, and choosing."""

from __future__ import annotations

import math
from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._parsing import arguments
from .boolean_substitution import truth

Comparable = SomeSubstitutionsType | int | float | bool | None


@expose_substitution("equals")
class EqualsSubstitution(Substitution):
    """`true` if both sides are the same text, the same truth value, or numbers that are nearly equal."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(equals `."""
        return cls, arguments("equals", data, ["left", "right"], 2)

    def __init__(self, left: Comparable, right: Comparable) -> None:
        self.__sides = [normalize_to_list_of_substitutions(_text(side)) for side in (left, right)]

    def describe(self) -> str:
        """Its name with both sides."""
        sides = ["".join(piece.describe() for piece in side) for side in self.__sides]
        return f"{type(self).__name__}({' '.join(sides)})"

    def _same(self, context: LaunchContext) -> bool:
        left, right = (perform_substitutions(context, side) for side in self.__sides)
        if {left.lower(), right.lower()} <= {"true", "false"} or left == right:
            return left.lower() == right.lower()
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return False

    def perform(self, context: LaunchContext) -> str:
        """`true` or `false`."""
        return str(self._same(context)).lower()


@expose_substitution("not-equals")
class NotEqualsSubstitution(EqualsSubstitution):
    """The opposite."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(not-equals `."""
        return cls, arguments("not-equals", data, ["left", "right"], 2)

    def perform(self, context: LaunchContext) -> str:
        """`true` or `false`."""
        return str(not self._same(context)).lower()


@expose_substitution("if")
class IfElseSubstitution(Substitution):
    """One of two texts, by a condition."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(if `."""
        return cls, arguments("if", data, ["condition", "if_value", "else_value"], 1)

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        self.__condition = normalize_to_list_of_substitutions(condition)
        self.__values = {
            True: normalize_to_list_of_substitutions(if_value),
            False: normalize_to_list_of_substitutions(else_value),
        }

    def perform(self, context: LaunchContext) -> str:
        """The text that the condition chooses."""
        return perform_substitutions(context, self.__values[truth(context, self.__condition)])


def _text(side: Any) -> Any:
    if side is None:
        return ""
    if isinstance(side, bool):
        return str(side).lower()
    return str(side) if isinstance(side, int | float) else side
