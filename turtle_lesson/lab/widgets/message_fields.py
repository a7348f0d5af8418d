"""Fields of messages: which ones a type has, of which kind, and which constants; and a message as a form has it.

Everything is read from what the generated Python classes of any ROS 2 offer (`get_fields_and_field_types`, constants as
attributes in capitals), so it works alike with the simulated ones and with the real ones.
"""

from __future__ import annotations

import importlib
import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from ...ros.idl.checks import FLOAT_BOUNDS
from ...ros.idl.names import integer_bounds
from ..words import same

Number = TypeVar("Number", int, float)

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
    value = _typed(float, text.strip(), "a number such as 1.5")
    if base == "float" and math.isfinite(value) and abs(value) > FLOAT_BOUNDS["float32"]:
        raise ValueError("a float32 goes up to 3.4e38")
    return value


def read_integer(text: str, base: str) -> int:
    """The whole number that was typed. Raises ValueError, in words, for what is none or does not fit in this type."""
    value = _typed(int, text.strip(), "a whole number such as 3")
    low, high = integer_bounds(base)
    if not low <= value <= high:
        raise ValueError(f"a whole number from {low} to {high} fits here, not {value}".replace("-", "−"))
    return value


def _typed(kind: Callable[[str], Number], text: str, wanted: str) -> Number:
    try:
        return kind(text.replace("−", "-"))
    except ValueError:
        if not text:
            raise ValueError(f"{wanted} is missing") from None
        shown = text if len(text) <= 30 else f"{text[:30]}…"
        why = ": write a point, not a comma" if "," in text else ""
        raise ValueError(f'{wanted} is wanted, got "{shown}"{why}') from None


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


# -- a form: a tree of groups, rows and single fields, each with the text that stands in it -------------------------------

MOST_ROWS = 64
"""More rows than this are no work for a form but for a program."""

TIME = "builtin_interfaces/Time"

Build = Callable[[], Any]
"""Gives the time of sending, as a message."""


class Part:
    """A part of a form: a single field, the fields of a message, or the rows of an array."""

    def __init__(self, name: str, kind: Kind, whole: Part | None) -> None:
        self.name, self.kind, self.whole = name, kind, whole
        self.parts: list[Part] = []

    @property
    def path(self) -> str:
        """Where it is, such as "linear/x" or "points/0/y"; "" for the whole form."""
        above = self.whole.path if self.whole is not None else ""
        return f"{above}/{self.name}" if above else self.name

    def singles(self) -> Iterator[Single]:
        """All single fields in here."""
        for part in self.parts:
            yield from part.singles()

    def build(self, now: Build) -> Any:
        """The value, as the message's field wants it."""
        raise NotImplementedError

    def value(self) -> Any:
        """The value, as YAML has it. Raises ValueError, in words, for what a field cannot be."""
        raise NotImplementedError

    def changed(self) -> Any:
        """The value as far as it is not the default, or None."""
        raise NotImplementedError

    def state(self) -> dict[str, Any]:
        """What the browser needs to draw it."""
        return {"path": self.path, "name": self.name, "type": str(self.kind)}


class Single(Part):
    """One value: a number, true or false, or a text. `text` is what stands in the field."""

    def __init__(self, name: str, kind: Kind, value: Any, constants: dict[str, Any], whole: Part | None = None) -> None:
        super().__init__(name, kind, whole)
        self.default = plain(value, kind)
        self.text: str | bool = self.default if isinstance(self.default, (bool, str)) else repr(self.default)
        self.constants = {each: found for each, found in constants.items() if self._fits(found)}

    def value(self) -> Any:
        if isinstance(self.text, bool):
            return self.text
        if self.text.strip() in self.constants:
            return self.constants[self.text.strip()]
        if self.kind.base in FLOATS:
            return read_float(self.text, self.kind.base)
        if self.kind.base in WHOLE:
            return read_integer(self.text, self.kind.base)
        if self.kind.longest and len(self.text) > self.kind.longest:
            raise ValueError(f"at most {self.kind.longest} characters fit here, these are {len(self.text)}")
        return self.text

    def build(self, now: Build) -> Any:
        value = self.value()
        return bytes([value]) if self.kind.base == "octet" else value

    def changed(self) -> Any:
        value = self.value()
        return None if same(value, self.default) else value

    def set(self, text: Any) -> None:
        """Put a text into the field; true or false into a checkbox. Raises ValueError for anything else."""
        wanted = bool if isinstance(self.text, bool) else str
        if not isinstance(text, wanted):
            raise ValueError(f"{self.path} takes {'true or false' if wanted is bool else 'a text'}, got {text!r}.")
        self.text = text

    def singles(self) -> Iterator[Single]:
        yield self

    def state(self) -> dict[str, Any]:
        base = self.kind.base
        hint = f"at most {self.kind.longest} characters" if self.kind.longest else ""
        if base in WHOLE:
            hint = "from {} to {}".format(*integer_bounds(base)).replace("-", "−")
        control = {"boolean": "checkbox", "string": "text", "wstring": "text"}.get(base, "number")
        options = [[name, str(value)] for name, value in self.constants.items()]
        return {**super().state(), "control": control, "help": hint, "options": options}

    def _fits(self, constant: Any) -> bool:
        base = self.kind.base
        if isinstance(constant, bool) or base == "boolean":
            return False
        if isinstance(constant, str) or "string" in base:
            return isinstance(constant, str) and "string" in base
        if base in FLOATS:
            return isinstance(constant, float)
        low, high = integer_bounds(base)
        return isinstance(constant, int) and low <= constant <= high


class Group(Part):
    """The fields of one message. If `is_time`, it is a time that can be filled with the moment of sending."""

    def __init__(
        self,
        message_class: Any,
        name: str = "",
        kind: Kind = Kind(""),
        message: Any = None,
        whole: Part | None = None,
    ) -> None:
        super().__init__(name, kind, whole)
        self.message_class = message_class
        self.is_time = kind.base == TIME
        self.now = self.is_time and self.path.endswith("header/stamp")
        message = message_class() if message is None else message
        constants, kinds = constants_of(message_class), kinds_of(message_class)
        for field, found in kinds.items():
            value = getattr(message, field)
            self.parts.append(make_part(field, found, value, _meant_for(field, kinds, constants), self))

    def build(self, now: Build) -> Any:
        if self.now:
            return now()
        message = self.message_class()
        for part in self.parts:
            setattr(message, part.name, part.build(now))
        return message

    def value(self) -> dict[str, Any]:
        return {part.name: part.value() for part in self.parts}

    def changed(self) -> Any:
        if self.now:  # a time that is filled in later is left out
            return None
        found = {part.name: value for part in self.parts if (value := part.changed()) is not None}
        return found or None

    def singles(self) -> Iterator[Single]:
        return iter(()) if self.now else super().singles()

    def state(self) -> dict[str, Any]:
        own = {"control": "time" if self.is_time else "group", "now": self.now}
        return {**super().state(), **own, "parts": [part.state() for part in self.parts]}


class Rows(Part):
    """An array: a row for each element."""

    def __init__(
        self, name: str, kind: Kind, values: Any, constants: dict[str, Any], whole: Part | None = None
    ) -> None:
        super().__init__(name, kind, whole)
        self._constants = constants
        for value in values.tolist() if hasattr(values, "tolist") else values:  # numpy's numbers are not Python's
            self._append(value)
        self.default = self.value()

    def _append(self, value: Any) -> None:
        self.parts.append(make_part(str(len(self.parts)), self.kind.element, value, self._constants, self))

    @property
    def why_full(self) -> str:
        """Why there can be no more rows; "" if there can."""
        if self.kind.array == "fixed":
            return f"always {self.kind.size}"
        if self.kind.array == "bounded" and len(self.parts) >= self.kind.size:
            return f"at most {self.kind.size}"
        return f"a form takes at most {MOST_ROWS}; a program, more" if len(self.parts) >= MOST_ROWS else ""

    def add(self) -> None:
        """Add a row at the end. Raises ValueError if there can be no more."""
        if self.why_full:
            raise ValueError(f"{self.path} can have no more rows: {self.why_full}.")
        base = self.kind.base
        empty: Any = {"boolean": False, "float": 0.0, "double": 0.0, "string": "", "wstring": ""}.get(base, 0)
        self._append(find_class(base)() if self.kind.is_message else empty)

    def remove(self, number: int) -> None:
        """Take a row away; those below move up."""
        if self.kind.array == "fixed" or not isinstance(number, int) or not 0 <= number < len(self.parts):
            raise ValueError(f"{self.path} has no row {number!r} to remove.")
        del self.parts[number]
        for at, row in enumerate(self.parts):
            row.name = str(at)

    def build(self, now: Build) -> list[Any]:
        return [row.build(now) for row in self.parts]

    def value(self) -> list[Any]:
        return [row.value() for row in self.parts]

    def changed(self) -> Any:
        if self.kind.is_message:
            values = [row.changed() or {} for row in self.parts]
            return values if len(values) != len(self.default) or any(values) else None
        values = self.value()
        return None if same(values, self.default) else values

    def state(self) -> dict[str, Any]:
        own = {"control": "rows", "full": self.why_full, "fixed": self.kind.array == "fixed"}
        return {**super().state(), **own, "parts": [row.state() for row in self.parts]}


def make_part(name: str, kind: Kind, value: Any, constants: dict[str, Any], whole: Part) -> Part:
    """The part of a form for a field of this kind, with this value in it."""
    if kind.array:
        return Rows(name, kind, value, constants, whole)
    if kind.is_message:
        return Group(find_class(kind.base), name, kind, value, whole)
    return Single(name, kind, value, constants, whole)


def find_part(whole: Part, path: str) -> Part:
    """The part at a path such as "linear/x" or "points/0/y". Raises ValueError if there is none."""
    for step in path.split("/"):
        inner = {part.name: part for part in whole.parts}
        if step not in inner:
            raise ValueError(f"This form has no field {path!r}.")
        whole = inner[step]
    return whole


def _meant_for(field: str, kinds: dict[str, Kind], constants: dict[str, Any]) -> dict[str, Any]:
    """The constants that a field may be set to. A type does not say which belong to which field: their names may.

    Constants that begin with a field's name (POWER_SUPPLY_STATUS_FULL) are that field's alone.
    """
    prefix = {name: f"{name.upper()}_" for name in kinds}
    own = {name: value for name, value in constants.items() if name.startswith(prefix[field])}
    if own:
        return own
    taken = [each for each in prefix.values() if any(constant.startswith(each) for constant in constants)]
    return {name: value for name, value in constants.items() if not name.startswith(tuple(taken))}
