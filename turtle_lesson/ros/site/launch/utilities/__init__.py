"""Small helpers that actions and substitutions share, and that some launch files use."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from .._missing import explain_missing
from ..some_types import SomeSubstitutionsType
from ..substitution import Substitution

if TYPE_CHECKING:
    from ..launch_context import LaunchContext

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
    from ..substitutions.text_substitution import TextSubstitution

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


def perform_text_as(context: LaunchContext, value: Any, kind: type) -> Any:
    """A plain value as it is; a substitution's text read as YAML, which must give a value of `kind`."""
    from turtle_lesson.ros.bounded_yaml import safe_load

    if isinstance(value, kind) and not isinstance(value, Substitution):
        return value
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    text = perform_substitutions(context, normalize_to_list_of_substitutions(value))
    if kind is str:
        return text
    found = safe_load(text)
    if kind is float and isinstance(found, int) and not isinstance(found, bool):
        return float(found)
    if not isinstance(found, kind) or (kind is int and isinstance(found, bool)):
        raise TypeError(f"expected a value of type {kind.__name__}, got {text!r}")
    return found


__getattr__ = explain_missing(__name__, {"create_future": "", "create_futures": ""})
