"""From what a launch file gives as parameters to plain names and values.

Facts: launch_ros's normalize_parameters.py and evaluate_parameters.py. A Python value keeps its type, text
stays text, and what a substitution gives is read as YAML: `5.0` is a double, `10` an integer, `true` a bool.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from launch import LaunchContext

PLAIN = (bool, int, float, str)


class ParameterTypeError(TypeError):
    """A parameter's value is of no type that ROS has. `hint` says what to try."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


def parameters_in(context: LaunchContext, given: Mapping[Any, Any]) -> Iterator[tuple[str, Any]]:
    """The names and values of a dictionary of parameters; nested dictionaries give names with dots."""
    for key, value in given.items():
        name = perform_substitutions(context, normalize_to_list_of_substitutions(key))
        if isinstance(value, Mapping):
            for inner, inner_value in parameters_in(context, value):
                yield f"{name}.{inner}", inner_value
        else:
            yield name, _named(name, context, value)


def _named(name: str, context: LaunchContext, value: Any) -> Any:
    try:
        return value_of(context, value)
    except ParameterTypeError as error:
        error.hint = f"This is parameter '{name}'. {error.hint}".strip()
        raise


def value_of(context: LaunchContext, value: Any) -> Any:
    """One value, substitutions performed.

    Raises:
        ParameterTypeError: if no ROS parameter can have it.
    """
    if hasattr(value, "evaluate"):  # a ParameterValue
        return value.evaluate(context)
    if isinstance(value, PLAIN):
        return value
    if isinstance(value, Substitution):
        return _from_text(perform_substitutions(context, [value]))
    if isinstance(value, Sequence) and not isinstance(value, bytes):
        return _from_sequence(context, value)
    raise ParameterTypeError(
        f"Unexpected type for parameter value {value!r}",
        "It can be a bool, int, float, text, or a list.",
    )


def _from_text(text: str) -> Any:
    """What YAML makes of a substitution's text; an empty text stays one (launch_ros, pull request 300)."""
    from turtle_lesson.ros.bounded_yaml import safe_load

    if not text:
        return ""
    value = safe_load(text)
    if isinstance(value, PLAIN):
        return value
    if isinstance(value, list):
        return uniform(value)
    raise ParameterTypeError(
        "Allowed value types are bytes, bool, int, float, str, Sequence[bool], Sequence[int], "
        f"Sequence[float], Sequence[str]. Got {type(value)}.",
        f"The text is {text!r}; ParameterValue(…, value_type=str) keeps it as text.",
    )


def _from_sequence(context: LaunchContext, items: Sequence[Any]) -> Any:
    from turtle_lesson.ros.bounded_yaml import safe_load

    if any(isinstance(item, Substitution) for item in items):
        pieces = normalize_to_list_of_substitutions(items)
        return _from_text(perform_substitutions(context, pieces))
    if any(isinstance(item, Sequence) and not isinstance(item, str) for item in items):
        texts = [perform_substitutions(context, normalize_to_list_of_substitutions(item)) for item in items]
        return uniform([safe_load(text) for text in texts])
    return uniform(list(items))


def uniform(items: list[Any]) -> list[Any]:
    """The items if they are of one type, integers among floats made floats.

    Raises:
        ParameterTypeError: if they are not, or if there are none.
    """
    kinds = {type(item) for item in items}
    if kinds == {int, float}:
        return [float(item) for item in items]
    if len(kinds) == 1 and kinds <= set(PLAIN):
        return items
    raise ParameterTypeError(
        "Expected a non-empty sequence, with items of uniform type. Allowed sequence item types are bool, "
        "int, float, str.",
        f"Got {items!r}.",
    )


def as_argument(value: Any) -> str:
    """A value as it stands after `name:=` on a command line, such that YAML reads the same value again."""
    import yaml

    def dump(readable: bool) -> str:
        return yaml.safe_dump(value, default_flow_style=True, allow_unicode=readable, width=float("inf"))

    text = dump(True)
    if any(line_end in text for line_end in "\x85\u2028\u2029"):  # which PyYAML would fold away
        text = dump(False)
    return text.removesuffix("\n").removesuffix("\n...")
