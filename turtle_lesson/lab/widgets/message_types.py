"""Message types as data: which fields a class has, of which kind, and which constants; and the values of parameters.

Everything is read from what the generated Python classes of any ROS 2 offer (`get_fields_and_field_types`, constants as
attributes in capitals), so it works alike with the simulated ones and with the real ones.
"""

from __future__ import annotations

import importlib
import math
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...ros.idl.checks import FLOAT_BOUNDS
from ...ros.idl.names import integer_bounds

FLOATS = {"float", "double"}
WHOLE = {"octet", "char"} | {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}
NAMES = {"float": "float32", "double": "float64", "boolean": "bool", "octet": "byte"}
"""How a .msg file calls what a Python class calls by its IDL name."""

_SEQUENCE = re.compile(r"sequence<(.+?)(?:, (\d+))?>$")
_FIXED = re.compile(r"(.+)\[(\d+)\]$")
_BOUNDED_TEXT = re.compile(r"(w?string)<(\d+)>$")


@dataclass(frozen=True, slots=True)
class Kind:
    """The kind of a field: of what, how many, how long."""

    base: str
    """"double", "int32", "boolean", "octet", "string", …, or a message such as "geometry_msgs/Vector3"."""
    array: str = ""
    """"", "fixed" (exactly `size`), "bounded" (at most `size`) or "unbounded"."""
    size: int = 0
    longest: int = 0
    """Most characters of a bounded string; 0 for any number."""

    @property
    def is_message(self) -> bool:
        """Whether a value, or each element, has fields of its own."""
        return "/" in self.base

    @property
    def is_number(self) -> bool:
        """Whether it is one number, or true and false, that can be drawn as one."""
        return not self.array and self.base in WHOLE | FLOATS | {"boolean"}

    @property
    def element(self) -> Kind:
        """The kind of one element."""
        return Kind(self.base, longest=self.longest)

    def __str__(self) -> str:
        """As a .msg file writes it: "float64[<=3]"."""
        ends = {"": "", "fixed": f"[{self.size}]", "bounded": f"[<={self.size}]", "unbounded": "[]"}
        return NAMES.get(self.base, self.base) + (f"<={self.longest}" if self.longest else "") + ends[self.array]


def read_kind(text: str) -> Kind:
    """The kind that `get_fields_and_field_types` calls `text`: "sequence<double, 3>", "uint8[4]", "string<10>", …"""
    array, size = "", 0
    if found := _SEQUENCE.match(text):
        text, array, size = found[1], "bounded" if found[2] else "unbounded", int(found[2] or 0)
    elif found := _FIXED.match(text):
        text, array, size = found[1], "fixed", int(found[2])
    if found := _BOUNDED_TEXT.match(text):
        return Kind(found[1], array, size, int(found[2]))
    return Kind(text, array, size)


def kinds_of(message_class: Any) -> dict[str, Kind]:
    """The fields of a message class, in the order of its file."""
    kinds = {name: read_kind(text) for name, text in message_class.get_fields_and_field_types().items()}
    # C++ allows no empty struct, so a message without fields has one that no file names
    return {} if list(kinds) == ["structure_needs_at_least_one_member"] else kinds


def constants_of(message_class: Any) -> dict[str, Any]:
    """The constants that a message class defines, in the order of its file; of type byte as numbers."""
    found: dict[str, Any] = {}
    for name, value in vars(message_class).items():
        if name.isupper() and name[0] != "_" and not name.endswith("__DEFAULT"):
            if isinstance(value, bytes) and len(value) == 1:
                value = value[0]
            if isinstance(value, (bool, int, float, str)):
                found[name] = value
    return found


def read_float(text: str, base: str) -> float:
    """The number that was typed. Raises ValueError, in words, for what is none or does not fit in this type."""
    try:
        value = float(text.strip().replace("−", "-"))
    except ValueError:
        raise ValueError(_no_number(text.strip(), "a number such as 1.5")) from None
    if base == "float" and math.isfinite(value) and abs(value) > FLOAT_BOUNDS["float32"]:
        raise ValueError("a float32 goes up to 3.4e38")
    return value


def read_integer(text: str, base: str) -> int:
    """The whole number that was typed. Raises ValueError, in words, for what is none or does not fit in this type."""
    try:
        value = int(text.strip().replace("−", "-"))
    except ValueError:
        raise ValueError(_no_number(text.strip(), "a whole number such as 3")) from None
    low, high = integer_bounds(base)
    if not low <= value <= high:
        raise ValueError(f"a whole number from {low} to {high} fits here, not {value}".replace("-", "−"))
    return value


def _no_number(text: str, wanted: str) -> str:
    if not text:
        return f"{wanted} is missing"
    shown = text if len(text) <= 30 else f"{text[:30]}…"
    return f'{wanted} is wanted, got "{shown}"' + (": write a point, not a comma" if "," in text else "")


def find_class(type_name: str) -> Any:
    """The class of "geometry_msgs/msg/Twist", "geometry_msgs/Twist", "turtlesim/srv/Spawn" or of an action's part.

    Those behind an action, such as "turtlesim/action/RotateAbsolute_FeedbackMessage", are found in it.

    Raises ValueError where it cannot be imported, with what to try.
    """
    package, _, rest = type_name.partition("/")
    folder, _, name = rest.rpartition("/")
    try:
        if "_" in name and folder in ("", "action"):
            action_name, _, part = name.partition("_")
            action = getattr(importlib.import_module(f"{package}.action"), action_name)
            if hasattr(action, part):  # X.Goal for "X_Goal"
                return getattr(action, part)
            # what carries it, such as X_FeedbackMessage or X_SendGoal, is in X.Impl
            return getattr(action.Impl, part if hasattr(action.Impl, part) else f"{part}Service")
        return getattr(importlib.import_module(f"{package}.{folder or 'msg'}"), name)
    except (ImportError, AttributeError):
        raise ValueError(
            f"the type {type_name} cannot be imported here: is its package built and sourced? Try "
            f"colcon build --packages-select {package}, then source install/setup.bash"
        ) from None


def plain(value: Any, kind: Kind | None = None) -> Any:
    """A message, or a field's value, as YAML and JSON have it: dictionaries, lists, numbers, text.

    A float32 is written with the digits that it has: 1.9, not 1.899999976158142.
    """
    if hasattr(value, "get_fields_and_field_types"):
        return {name: plain(getattr(value, name), each) for name, each in kinds_of(value).items()}
    if isinstance(value, float):
        return float(str(np.float32(value))) if kind is not None and kind.base == "float" else value
    if isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, (bytes, bytearray)):
        return value[0] if len(value) == 1 else list(value)
    numbers = value.tolist() if hasattr(value, "tolist") else value  # numpy's arrays and those of the array module
    return [plain(each, kind) for each in numbers]


# -- parameters ------------------------------------------------------------------------------------------------------

ARRAYS = ("byte array", "bool array", "integer array", "double array", "string array")
TYPES = ("not set", "bool", "integer", "double", "string", *ARRAYS)
"""By number of rcl_interfaces/msg/ParameterType."""

NOT_SET, BOOL, INTEGER, DOUBLE, STRING, BYTES, BOOLS, INTEGERS, DOUBLES, STRINGS = range(10)
ELEMENTS = {
    BYTES: (int, "whole numbers"),
    BOOLS: (bool, "true and false"),
    INTEGERS: (int, "whole numbers"),
    DOUBLES: (float, "numbers"),
    STRINGS: (str, "texts"),
}


def parameter_to_python(value: Any) -> Any:
    """What an rcl_interfaces/msg/ParameterValue holds, bytes as numbers; None if it is not set."""
    from rclpy.parameter import parameter_value_to_python

    found = parameter_value_to_python(value)
    return [each[0] for each in found] if value.type == BYTES else found


def shown_parameter(value: Any) -> str:
    """A value as it stands in a field: YAML for arrays."""
    if value is None:
        return ""
    if isinstance(value, list):
        import yaml

        return yaml.safe_dump(value, default_flow_style=True, width=float("inf"), allow_unicode=True).strip()
    return value if isinstance(value, str) else repr(value)


def read_parameter(typed: Any, kind: int, dynamic: bool = False) -> Any:
    """An rcl_interfaces/msg/ParameterValue from what was typed. Raises ValueError, in words, for what it cannot be.

    `kind` is the number of the type; a dynamically typed parameter, and one that is not set, takes what YAML makes of it.
    """
    from rclpy.parameter import Parameter, get_parameter_value

    if dynamic or kind == NOT_SET:
        return get_parameter_value(str(typed))
    return Parameter("", Parameter.Type(kind), _converted(typed, kind)).get_parameter_value()


def _converted(typed: Any, kind: int) -> Any:
    """What was typed, as a parameter of this type holds it."""
    if kind == BOOL and not isinstance(typed, bool):
        raise ValueError(f"expected true or false, got {typed!r}")
    if kind == BOOL:
        return typed
    if kind == INTEGER:
        return read_integer(str(typed), "int64")
    if kind == DOUBLE:
        return read_float(str(typed), "double")
    if kind == STRING:
        return str(typed)
    import yaml

    from ...ros.runtime.bounded_yaml import safe_load

    try:
        value = safe_load(str(typed))
    except yaml.YAMLError:
        raise ValueError(f'"{typed}" is not valid YAML: lists are written [1, 2, 3]') from None
    element, words = ELEMENTS[kind]
    if not isinstance(value, list):
        raise ValueError(f"a list of {words} is expected, such as [{'a, b' if element is str else '1, 2'}]")
    made: list[Any] = [float(each) if element is float and type(each) is int else each for each in value]
    for each in made:
        if type(each) is not element:
            raise ValueError(f"a list of {words} is expected, and {each!r} is none")
    return [bytes([each]) for each in made] if kind == BYTES else made
