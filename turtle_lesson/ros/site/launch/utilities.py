"""Functions that actions and substitutions share, and that some launch files use (facts: launch.utilities)."""

from __future__ import annotations

from typing import Any, get_args, get_origin

from turtle_lesson.ros.runtime.bounded_yaml import safe_load

from ._context import LaunchContext
from ._entities import normalize_to_list_of_substitutions, perform_substitutions, text_of

__all__ = ["normalize_to_list_of_substitutions", "perform_substitutions"]


def perform_text_as(context: LaunchContext, value: Any, kind: type) -> Any:
    """A plain value as it is; a substitution's text made a value of `kind`. Raises TypeError if it is no such value."""
    if isinstance(value, kind):
        return value
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    text = text_of(context, value)
    try:
        return value_in_text(text, kind)
    except ValueError:
        raise TypeError(f"expected a value of type {kind.__name__}, got {text!r}") from None


SCALARS = (int, float, bool, str)


def is_of_type(value: object, data_type: Any, can_be_str: bool = False) -> bool:
    """Whether a value is of a type such as `bool` or `list[float]`, or, with `can_be_str`, text instead.

    None stands for any type that a parameter can have: a scalar, or a list of scalars of one type.
    """
    if get_origin(data_type) is list or (data_type is None and isinstance(value, list)):
        kinds = get_args(data_type) or SCALARS
        return isinstance(value, list) and any(
            all(is_of_type(item, kind, can_be_str) for item in value) for kind in kinds
        )
    kind = SCALARS if data_type is None else data_type
    return isinstance(value, kind) or (can_be_str and isinstance(value, str))


def value_in_text(text: str, data_type: Any = None, can_be_str: bool = False) -> Any:
    """Text made a value of a type (None: by YAML's rules). Raises ValueError if it is none, unless it `can_be_str`."""
    try:
        if data_type in (int, float, str):
            return data_type(text)
        found = safe_load(text)
    except Exception as error:
        if can_be_str:
            return text
        raise ValueError(f"Failed to convert '{text}' to '{data_type or 'a value'}'\n{error}") from error
    if not is_of_type(found, data_type, can_be_str):
        raise ValueError(f"Cannot convert value '{text}' to '{data_type or 'a value'}'")
    return found
