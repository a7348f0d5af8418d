"""The type aliases under their real module's name."""

from .some_types import SomeEntitiesType

__all__ = ["SomeEntitiesType"]
