"""Values of parameters: as a panel shows them, and from what was typed."""

from __future__ import annotations

from typing import Any

TYPES = (
    "not set",
    "bool",
    "integer",
    "double",
    "string",
    "byte array",
    "bool array",
    "integer array",
    "double array",
    "string array",
)
"""By number of rcl_interfaces/msg/ParameterType."""

NOT_SET, BOOL, INTEGER, DOUBLE, STRING, BYTES, BOOLS, INTEGERS, DOUBLES, STRINGS = range(10)
_ELEMENTS = {BYTES: int, BOOLS: bool, INTEGERS: int, DOUBLES: float, STRINGS: str}
_WORDS = {int: "whole numbers", bool: "true and false", float: "numbers", str: "texts"}
_LARGEST = 2**63


def to_python(value: Any) -> Any:
    """What an rcl_interfaces/msg/ParameterValue holds; None if it is not set."""
    if not NOT_SET < value.type < len(TYPES):
        return None
    found = getattr(value, _field(value.type))
    return [each[0] if isinstance(each, bytes) else each for each in found] if value.type >= BYTES else found


def _field(kind: int) -> str:
    return f"{TYPES[kind].replace(' ', '_')}_value"


def shown(value: Any) -> str:
    """A value as it stands in a field: YAML for arrays."""
    if value is None:
        return ""
    if isinstance(value, list):
        import yaml

        return yaml.safe_dump(value, default_flow_style=True, width=float("inf"), allow_unicode=True).strip()
    return value if isinstance(value, str) else repr(value)


def read(typed: Any, kind: int, dynamic: bool = False) -> Any:
    """An rcl_interfaces/msg/ParameterValue from what was typed. Raises ValueError, in words, for what it cannot be.

    `kind` is the number of the type; a dynamically typed parameter, and one that is not set, takes what YAML makes of it.
    """
    from rcl_interfaces.msg import ParameterValue

    if dynamic or kind == NOT_SET:
        value, kind = _guessed(typed)
    else:
        value = _converted(typed, kind)
    message = ParameterValue(type=kind)
    setattr(message, _field(kind), [bytes([each]) for each in value] if kind == BYTES else value)
    return message


def _converted(typed: Any, kind: int) -> Any:
    if kind == BOOL:
        return _boolean(typed)
    text = str(typed).strip().replace("−", "-")
    if kind == INTEGER:
        return _whole(text)
    if kind == DOUBLE:
        return _decimal(text)
    return str(typed) if kind == STRING else _array(_yaml(str(typed)), _ELEMENTS[kind])


def _boolean(typed: Any) -> bool:
    if not isinstance(typed, bool):
        raise ValueError(f"expected true or false, got {typed!r}")
    return typed


def _whole(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        raise ValueError(f'expected a whole number, got "{text}"') from None
    if not -_LARGEST <= value < _LARGEST:
        raise ValueError("expected a whole number of 64 bits, and this one is larger")
    return value


def _decimal(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        hint = ": write a point, not a comma" if "," in text else ""
        raise ValueError(f'expected a number, got "{text}"{hint}') from None


def _array(value: Any, element: type) -> list[Any]:
    if not isinstance(value, list):
        raise ValueError(f"a list of {_WORDS[element]} is expected, such as [{'a, b' if element is str else '1, 2'}]")
    made = [float(each) if element is float and type(each) is int else each for each in value]
    for each in made:
        if type(each) is not element:
            raise ValueError(f"a list of {_WORDS[element]} is expected, and {each!r} is none")
    return made


def _guessed(typed: Any) -> tuple[Any, int]:
    """A value of any type, and which: as `ros2 param set` reads it."""
    value = typed if isinstance(typed, bool) else _yaml(str(typed))
    singles: list[tuple[type, int]] = [(bool, BOOL), (int, INTEGER), (float, DOUBLE)]
    for element, kind in singles:
        if type(value) is element:
            return value, kind
    lists: list[tuple[type, int]] = [(bool, BOOLS), (int, INTEGERS), (float, DOUBLES), (str, STRINGS)]
    for element, kind in lists:
        if isinstance(value, list) and all(type(each) is element for each in value):
            return value, kind
    return str(typed), STRING


def _yaml(text: str) -> Any:
    import yaml

    from ...ros.runtime.files import safe_load

    try:
        return safe_load(text)
    except yaml.YAMLError:
        raise ValueError(f'"{text}" is not valid YAML: lists are written [1, 2, 3]') from None
