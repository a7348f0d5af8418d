"""Whether a type stands for a list of nested entities."""

from __future__ import annotations

from typing import Any, get_args, get_origin

from .entity import Entity


def check_is_list_entity(data_type: Any) -> bool:
    """Whether it is `List[Entity]`, or a list of a subclass."""
    return get_origin(data_type) is list and all(
        isinstance(kind, type) and issubclass(kind, Entity) for kind in get_args(data_type)
    )
