"""Fields of messages: which ones a type has, and of which kind; and the fields of a form.

Everything is read from what the generated Python classes of any ROS 2 offer (`get_fields_and_field_types`), so it works
alike with the simulated ones and with the real ones.
"""

from __future__ import annotations

import json
import math
import re
from dataclasses import dataclass
from functools import reduce
from typing import Any

from rosidl_runtime_py import message_to_ordereddict, set_message_fields

from ...ros.idl.names import bounds
from ...ros.runtime.bounded_yaml import safe_load
from ..words import shortened

FLOATS = {"float", "double"}
WHOLE = {"octet", "char"} | {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}
NAMES = {"float": "float32", "double": "float64", "boolean": "bool", "octet": "byte"}
"""How a .msg file calls what a Python class calls by its IDL name."""

_KIND = re.compile(r"(sequence<)?([\w/]+)(?:<\d+>)?(?:, (\d+))?>?(?:\[(\d+)\])?")
"""An array of any length, the base, most elements, just so many elements; how long a text may be is passed over."""


@dataclass(frozen=True, slots=True)
class Kind:
    """The kind of a field: of what, and how many."""

    base: str
    """"double", "int32", "boolean", "octet", "string", …, or a message such as "geometry_msgs/Vector3"."""
    array: str = ""
    """As a .msg file writes it: "", "[36]" (always so many elements), "[<=3]" (at most so many) or "[]"."""

    @property
    def is_message(self) -> bool:
        """Whether a value, or each element, has fields of its own."""
        return "/" in self.base

    def __str__(self) -> str:
        """As a .msg file writes it: "float64[<=3]"."""
        return NAMES.get(self.base, self.base) + self.array


def read_kind(text: str) -> Kind:
    """The kind that `get_fields_and_field_types` calls `text`: "sequence<double, 3>", "uint8[4]", "string<10>", …"""
    found = _KIND.fullmatch(text)
    assert found is not None, text
    sequence, base, most, size = found.groups()
    return Kind(base, f"[{size}]" if size else f"[<={most}]" if most else "[]" if sequence else "")


def kinds_of(message_class: Any) -> dict[str, Kind]:
    """The fields of a message class, in the order of its file."""
    return {name: read_kind(text) for name, text in message_class.get_fields_and_field_types().items()}


def read_number(text: str, base: str) -> float:
    """The number that was typed. Raises ValueError, in words, for what is none or does not fit in this type."""
    typed, is_float = text.strip().replace("−", "-"), base in FLOATS
    wanted = "a number such as 1.5" if is_float else "a whole number such as 3"
    try:
        value = float(typed) if is_float else int(typed)
    except ValueError:
        why = ": write a point, not a comma" if "," in typed else ""
        raise ValueError(f'{wanted} is wanted, got "{shortened(typed, 30)}"{why}') from None
    low, high = bounds(NAMES.get(base, base))
    if not low <= value <= high and not (is_float and not math.isfinite(value)):
        raise ValueError(f"a number from {low} to {high} fits here, not {value}".replace("-", "−"))
    return value


# -- a form: its fields in the order of the type, each with the text that stands in it ------------------------------------

TIME = "builtin_interfaces/Time"


class Field:
    """One field of a form. `text` is what stands in it: true or false in a checkbox, YAML for a list, nothing for a group."""

    def __init__(self, path: str, kind: Kind, value: Any) -> None:
        self.path, self.kind = path, kind
        """Where it is, such as "linear/x"."""
        self.control = {"boolean": "checkbox", "string": "text", "wstring": "text"}.get(kind.base, "number")
        """What the browser draws; a header's stamp is "now", the moment of sending."""
        self.text: str | bool = value if isinstance(value, (bool, str)) else repr(value)
        if kind.array:
            self.control, self.text = "text", json.dumps(value)
        elif kind.is_message:
            self.control = "now" if kind.base == TIME and path.endswith("header/stamp") else "group"
        self.default = self.value() if self.is_single else None

    @property
    def is_single(self) -> bool:
        """Whether something can be put into it."""
        return self.control not in ("group", "now")

    def value(self) -> Any:
        """The value as YAML has it. Raises ValueError, in words, for what it cannot be."""
        if isinstance(self.text, bool):
            return self.text
        if self.kind.array:
            return read_list(self.text)
        return read_number(self.text, self.kind.base) if self.kind.base in FLOATS | WHOLE else self.text

    def put_into(self, message: Any, value: Any) -> None:
        """Set the field of a message as `ros2 topic pub` does. Raises ValueError, in words, for what it cannot be."""
        *groups, name = self.path.split("/")
        if self.kind == Kind("octet"):
            value = bytes([value])
        try:
            set_message_fields(reduce(getattr, groups, message), {name: value})
        except (AssertionError, AttributeError, OverflowError, TypeError) as error:
            raise ValueError(f"{error}") from None

    def state(self) -> dict[str, str]:
        """What the browser needs to draw it."""
        hint = ""
        if self.kind.array:
            hint = "a list in YAML: [{field: value, …}, …]" if self.kind.is_message else "a list in YAML: [value, …]"
        elif self.kind.base in WHOLE:
            hint = "from {} to {}".format(*bounds(self.kind.base)).replace("-", "−")
        return {"path": self.path, "type": str(self.kind), "control": self.control, "help": hint}


def fields_of(message: Any, above: str = "") -> list[Field]:
    """The fields of a message for a form, with its values in them; groups come before what is in them."""
    found: list[Field] = []
    plain = message_to_ordereddict(message)
    for name, kind in kinds_of(message).items():
        value = getattr(message, name)
        field = Field(f"{above}{name}", kind, value[0] if kind == Kind("octet") else plain[name])
        found += [field, *(fields_of(value, f"{field.path}/") if field.control == "group" else [])]
    return found


def read_list(text: str) -> list[Any]:
    """The list that was typed, as YAML. Raises ValueError, in words, for anything else."""
    import yaml

    try:
        values = safe_load(text)
    except yaml.YAMLError:
        values = None
    if not isinstance(values, list):
        raise ValueError("a list such as [1.5, 2.0] or [{x: 1.5}, {x: 2.0}] is wanted")
    return values
