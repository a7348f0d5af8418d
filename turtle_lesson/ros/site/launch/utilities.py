"""Functions that actions and substitutions share, and that some launch files use (facts: launch.utilities)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, get_args, get_origin

from turtle_lesson.ros.runtime.bounded_yaml import safe_load

from ._entities import SomeSubstitutionsType, Substitution, TextSubstitution

if TYPE_CHECKING:
    from ._context import LaunchContext

__all__ = [
    "ensure_argument_type",
    "is_a",
    "is_a_subclass",
    "normalize_to_list_of_substitutions",
    "perform_substitutions",
    "perform_text_as",
]


def ensure_argument_type(
    argument: object, types: type | Iterable[type], argument_name: str, caller: str | None = None
) -> None:
    """Raise TypeError, with the real text, unless the argument is of one of the types."""
    allowed = [types] if isinstance(types, type) else list(types)
    if isinstance(argument, tuple(allowed)):
        return
    who = f"'{caller}' expected" if caller else "Expected"
    raise TypeError(f"{who} '{argument_name}' to be one of {allowed}, but got '{argument}' of type '{type(argument)}'")


def is_a(obj: object, entity_type: type) -> bool:
    """Whether it is an instance."""
    return isinstance(obj, entity_type)


def is_a_subclass(obj: object, entity_type: type) -> bool:
    """Whether it is an instance, or a subclass."""
    return isinstance(obj, entity_type) or (isinstance(obj, type) and issubclass(obj, entity_type))


def normalize_to_list_of_substitutions(subs: SomeSubstitutionsType) -> list[Substitution]:
    """A list of substitutions, whether text, one substitution, or several of both were given."""
    if isinstance(subs, str | Substitution) or not isinstance(subs, Iterable):
        return [_as_substitution(subs)]
    return [_as_substitution(part) for part in subs]


def _as_substitution(part: object) -> Substitution:
    if isinstance(part, Substitution):
        return part
    if isinstance(part, str):
        return TextSubstitution(text=part)
    raise TypeError(
        f"Failed to normalize given item of type '{type(part)}', when only "
        "'str' or 'launch.Substitution' were expected."
    )


def perform_substitutions(context: LaunchContext, subs: Iterable[Substitution]) -> str:
    """The texts of all, joined."""
    return "".join([context.perform_substitution(part) for part in subs])


def text_of(context: LaunchContext, given: SomeSubstitutionsType) -> str:
    """The text of whatever can stand for text."""
    return perform_substitutions(context, normalize_to_list_of_substitutions(given))


def perform_text_as(context: LaunchContext, value: Any, kind: type) -> Any:
    """A plain value as it is; a substitution's text made a value of `kind`. Raises TypeError if it is no such value."""
    if isinstance(value, kind) and not isinstance(value, Substitution):
        return value
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    text = text_of(context, value)
    try:
        return coerce_to_type(text, kind)
    except ValueError:
        raise TypeError(f"expected a value of type {kind.__name__}, got {text!r}") from None


SCALARS = (int, float, bool, str)


def extract_type(data_type: Any) -> tuple[type, bool]:
    """A type such as `bool` or `List[float]`, as the scalar type and whether it is a list.

    Raises ValueError if it is neither a scalar type nor a list of one.
    """
    is_list = get_origin(data_type) is list
    kind = get_args(data_type)[0] if is_list else data_type
    if kind not in SCALARS:
        raise ValueError(f"Unrecognized data type: {data_type}")
    return kind, is_list


def is_instance_of_valid_type(value: Any, can_be_str: bool = False) -> bool:
    """Whether it is a scalar or a list of scalars of one type; with `can_be_str`, text may be among them."""
    if not isinstance(value, list):
        return isinstance(value, SCALARS)
    kinds = {type(item) for item in value}
    if can_be_str and len(kinds) == 2:
        kinds.discard(str)
    return len(kinds) <= 1 and kinds <= set(SCALARS)


def is_instance_of(value: Any, data_type: Any = None, can_be_str: bool = False) -> bool:
    """Whether a value is of a type; None stands for any type that a parameter can have."""
    if data_type is None:
        return is_instance_of_valid_type(value, can_be_str)
    kind, is_list = extract_type(data_type)
    kinds = (str, kind) if can_be_str else (kind,)
    if not is_list:
        return isinstance(value, kinds)
    return isinstance(value, list) and all(isinstance(item, kinds) for item in value)


def coerce_to_type(value: str, data_type: Any = None, can_be_str: bool = False) -> Any:
    """Text made a value of a type (None: by YAML's rules). Raises ValueError if it is none, unless it `can_be_str`."""
    kind, is_list = (None, False) if data_type is None else extract_type(data_type)
    try:
        if kind in (int, float, str) and not is_list:
            return kind(value)
        found = safe_load(value)
    except Exception as error:
        if can_be_str:
            return value
        raise ValueError(f"Failed to convert '{value}' to '{data_type or 'a value'}'\n{error}") from error
    if not is_instance_of(found, data_type, can_be_str):
        raise ValueError(f"Cannot convert value '{value}' to '{data_type or 'a value'}'")
    return found


def get_typed_value(value: str | list[str], data_type: Any, can_be_str: bool = False) -> Any:
    """Text, or a list of texts, made a value of a type.

    Raises ValueError if it is no such value, and TypeError if a list is given for a type that is none.
    """
    if isinstance(value, str):
        return coerce_to_type(value, data_type, can_be_str)
    kind, is_list = (None, True) if data_type is None else extract_type(data_type)
    if not is_list:
        raise TypeError(f"Cannot convert input '{value}' of type '{type(value)}' to '{kind}'")
    items = [coerce_to_type(item, kind, can_be_str) for item in value]
    if not is_instance_of_valid_type(items, can_be_str):
        raise ValueError(f"cannot convert value to {kind}. Got value=`{value}`")
    return items
