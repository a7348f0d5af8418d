"""Substitutions that give `true` or `false`: not, and, or."""

from __future__ import annotations

from typing import Any

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._parsing import arguments
from .substitution_failure import SubstitutionFailure


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
