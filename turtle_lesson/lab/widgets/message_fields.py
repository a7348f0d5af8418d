"""Fields of messages: which ones a type has, and of which kind; and a message as a form has it.

Everything is read from what the generated Python classes of any ROS 2 offer (`get_fields_and_field_types`), so it works
alike with the simulated ones and with the real ones.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...ros.idl.names import bounds
from ..recorder import find_class
from ..words import same, shortened

FLOATS = {"float", "double"}
WHOLE = {"octet", "char"} | {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}
NAMES = {"float": "float32", "double": "float64", "boolean": "bool", "octet": "byte"}
"""How a .msg file calls what a Python class calls by its IDL name."""

_KIND = re.compile(r"(sequence<)?([\w/]+)(?:<(\d+)>)?(?:, (\d+))?>?(?:\[(\d+)\])?")
"""An array of any length, the base, most characters, most elements, just so many elements."""


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
    found = _KIND.fullmatch(text)
    assert found is not None, text
    sequence, base, longest, most, size = found.groups()
    array = "fixed" if size else "bounded" if most else "unbounded" if sequence else ""
    return Kind(base, array, int(size or most or 0), int(longest or 0))


def kinds_of(message_class: Any) -> dict[str, Kind]:
    """The fields of a message class, in the order of its file."""
    kinds = {name: read_kind(text) for name, text in message_class.get_fields_and_field_types().items()}
    # C++ allows no empty struct, so a message without fields has one that no file names
    return {} if list(kinds) == ["structure_needs_at_least_one_member"] else kinds


def read_number(text: str, base: str) -> float:
    """The number that was typed. Raises ValueError, in words, for what is none or does not fit in this type."""
    typed, is_float = text.strip().replace("−", "-"), base in FLOATS
    wanted = "a number such as 1.5" if is_float else "a whole number such as 3"
    try:
        value = float(typed) if is_float else int(typed)
    except ValueError:
        if not typed:
            raise ValueError(f"{wanted} is missing") from None
        why = ": write a point, not a comma" if "," in typed else ""
        raise ValueError(f'{wanted} is wanted, got "{shortened(typed, 30)}"{why}') from None
    if base == "float" and math.isfinite(value) and abs(value) > bounds("float32")[1]:
        raise ValueError("a float32 goes up to 3.4e38")
    if not is_float:
        low, high = bounds(base)
        if not low <= value <= high:
            raise ValueError(f"a whole number from {low} to {high} fits here, not {value}".replace("-", "−"))
    return value


def plain(value: Any, kind: Kind) -> Any:
    """A number, truth or text of a field, as YAML and JSON have it.

    A float32 is written with the digits that it has: 1.9, not 1.899999976158142.
    """
    if isinstance(value, bytes):
        return value[0]
    value = value.item() if isinstance(value, np.generic) else value
    return float(str(np.float32(value))) if kind.base == "float" else value


LONGEST_LIST = 50
"""How many elements of an array are shown of a message."""


def in_yaml(message: Any) -> str:
    """A message in lines as `ros2 topic echo` shows it; of a long array the first elements."""
    import yaml

    fields = _shown(message, Kind(""))
    if not fields:
        return "(the answer has no fields)"
    return yaml.safe_dump(fields, sort_keys=False, allow_unicode=True, default_flow_style=False).strip()


def _shown(value: Any, kind: Kind) -> Any:
    if kind.array:
        rest = [f"… and {len(value) - LONGEST_LIST} more"] if len(value) > LONGEST_LIST else []
        return [*(_shown(each, kind.element) for each in value[:LONGEST_LIST]), *rest]
    if hasattr(value, "get_fields_and_field_types"):
        return {name: _shown(getattr(value, name), each) for name, each in kinds_of(value).items()}
    return plain(value, kind)


# -- a form: a tree of groups, rows and single fields, each with the text that stands in it -------------------------------

MOST_ROWS = 64
"""More rows than this are no work for a form but for a program."""

TIME = "builtin_interfaces/Time"


class Part:
    """A part of a form: a single field, the fields of a message, or the rows of an array."""

    def __init__(self, name: str, kind: Kind, value: Any, whole: Part | None = None) -> None:
        self.name, self.kind, self.whole = name, kind, whole
        self.parts: list[Part] = []
        self.default: Any = {}
        """The first value, as YAML has it; of a message, none of its fields."""
        self._fill(value)

    def _fill(self, value: Any) -> None:
        """Take this value as the default."""
        raise NotImplementedError

    @property
    def path(self) -> str:
        """Where it is, such as "linear/x" or "points/0/y"; "" for the whole form."""
        above = self.whole.path if self.whole is not None else ""
        return f"{above}/{self.name}" if above else self.name

    def singles(self) -> Iterator[Single]:
        """All single fields in here."""
        for part in self.parts:
            yield from part.singles()

    def build(self, now: Callable[[], Any]) -> Any:
        """The value, as the message's field wants it; `now` gives the time of sending.

        Raises ValueError, in words, for what a field cannot be.
        """
        raise NotImplementedError

    def value(self) -> Any:
        """The value, as YAML has it: of a message, the fields that are not the default. Raises ValueError as `build` does."""
        raise NotImplementedError

    def changed(self) -> Any:
        """The value as YAML has it, as far as it is not the default, or None."""
        value = self.value()
        return None if same(value, self.default) else value

    def state(self) -> dict[str, Any]:
        """What the browser needs to draw it."""
        return {"path": self.path, "name": self.name, "type": str(self.kind)}


class Single(Part):
    """One value: a number, true or false, or a text. `text` is what stands in the field."""

    def _fill(self, value: Any) -> None:
        self.default = plain(value, self.kind)
        self.text: str | bool = self.default if isinstance(self.default, (bool, str)) else repr(self.default)

    def value(self) -> Any:
        if isinstance(self.text, bool):
            return self.text
        if self.kind.base in FLOATS | WHOLE:
            return read_number(self.text, self.kind.base)
        if self.kind.longest and len(self.text) > self.kind.longest:
            raise ValueError(f"at most {self.kind.longest} characters fit here, these are {len(self.text)}")
        return self.text

    def build(self, now: Callable[[], Any]) -> Any:
        value = self.value()
        return bytes([value]) if self.kind.base == "octet" else value

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
            hint = "from {} to {}".format(*bounds(base)).replace("-", "−")
        control = {"boolean": "checkbox", "string": "text", "wstring": "text"}.get(base, "number")
        return {**super().state(), "control": control, "help": hint}


class Group(Part):
    """The fields of one message. A header's stamp is filled with the moment of sending: `now`."""

    def _fill(self, value: Any) -> None:
        self.message_class = type(value)
        self.now = self.kind.base == TIME and self.path.endswith("header/stamp")
        self.parts = [make_part(name, kind, getattr(value, name), self) for name, kind in kinds_of(value).items()]

    def build(self, now: Callable[[], Any]) -> Any:
        if self.now:
            return now()
        message = self.message_class()
        for part in self.parts:
            setattr(message, part.name, part.build(now))
        return message

    def value(self) -> Any:
        if self.now:  # a time that is filled in later is left out
            return {}
        return {part.name: value for part in self.parts if (value := part.changed()) is not None}

    def singles(self) -> Iterator[Single]:
        return iter(()) if self.now else super().singles()

    def state(self) -> dict[str, Any]:
        parts = [] if self.now else [part.state() for part in self.parts]
        return {**super().state(), "control": "now" if self.now else "group", "parts": parts}


class Rows(Part):
    """An array: a row for each element."""

    def _fill(self, value: Any) -> None:
        for each in value:
            self._append(each)
        self.default = self.value()

    def _append(self, value: Any) -> None:
        self.parts.append(make_part(str(len(self.parts)), self.kind.element, value, self))

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

    def build(self, now: Callable[[], Any]) -> list[Any]:
        return [row.build(now) for row in self.parts]

    def value(self) -> Any:
        return [row.value() for row in self.parts]

    def state(self) -> dict[str, Any]:
        own = {"control": "rows", "full": self.why_full, "fixed": self.kind.array == "fixed"}
        return {**super().state(), **own, "parts": [row.state() for row in self.parts]}


def make_part(name: str, kind: Kind, value: Any, whole: Part) -> Part:
    """The part of a form for a field of this kind, with this value in it."""
    made = Rows if kind.array else Group if kind.is_message else Single
    return made(name, kind, value, whole)


def form_of(message_class: Any) -> Group:
    """A form for messages of this class, with their defaults in it."""
    return Group("", Kind(""), message_class())


def find_part(whole: Part, path: str) -> Part:
    """The part at a path such as "linear/x" or "points/0/y". Raises ValueError if there is none."""
    for step in path.split("/"):
        inner = {part.name: part for part in whole.parts}
        if step not in inner:
            raise ValueError(f"This form has no field {path!r}.")
        whole = inner[step]
    return whole
