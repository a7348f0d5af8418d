"""The type aliases under their real module's name."""

from .some_types import SomeSubstitutionsType, SomeSubstitutionsType_types_tuple

__all__ = ["SomeSubstitutionsType", "SomeSubstitutionsType_types_tuple"]
