"""The type aliases under their real module's name."""

from .some_types import SomeActionsType

__all__ = ["SomeActionsType"]
