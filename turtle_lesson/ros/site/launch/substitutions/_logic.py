"""Substitutions that compare and combine truth values, and choose between texts."""

from __future__ import annotations

import math
from typing import Any

from .._context import LaunchContext
from .._entities import SomeSubstitutionsType, Substitution
from ..frontend import expose_substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._values import SubstitutionFailure, arguments


def truth(context: LaunchContext, value: SomeSubstitutionsType) -> bool:
    """Whether a substitution's text says yes.

    Raises:
        SubstitutionFailure: if it says neither yes nor no.
    """
    text = perform_substitutions(context, normalize_to_list_of_substitutions(value)).strip()
    if text.lower() in {"true", "1", "yes", "on"}:
        return True
    if text.lower() in {"false", "0", "no", "off"}:
        return False
    raise SubstitutionFailure(f"'{text}' is neither true nor false")


class _Combination(Substitution):
    """Several truth values made into one."""

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self._args = [normalize_to_list_of_substitutions(argument) for argument in args]

    def describe(self) -> str:
        """Its name with its parts."""
        parts = ["".join(piece.describe() for piece in part) for part in self._args]
        return f"{type(self).__name__}({' '.join(parts)})"

    def perform(self, context: LaunchContext) -> str:
        """`true` or `false`."""
        return str(self._combine([truth(context, part) for part in self._args])).lower()

    def _combine(self, values: list[bool]) -> bool:
        raise NotImplementedError


@expose_substitution("not")
class NotSubstitution(_Combination):
    """True if its part is false."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(not `."""
        return cls, arguments("not", data, ["value"], 1)

    def __init__(self, value: SomeSubstitutionsType) -> None:
        super().__init__(value)

    def _combine(self, values: list[bool]) -> bool:
        return not values[0]


@expose_substitution("and")
class AndSubstitution(_Combination):
    """True if both are."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(and `."""
        return cls, arguments("and", data, ["left", "right"], 2)

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)

    def _combine(self, values: list[bool]) -> bool:
        return all(values)


@expose_substitution("or")
class OrSubstitution(_Combination):
    """True if one is."""

    @classmethod
    def parse(cls, data: Any) -> tuple[type, dict[str, Any]]:
        """Its arguments as they stand behind `$(or `."""
        return cls, arguments("or", data, ["left", "right"], 2)

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)

    def _combine(self, values: list[bool]) -> bool:
        return any(values)


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
