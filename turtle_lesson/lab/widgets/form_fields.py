"""A message as a form has it: a tree of groups, rows and single fields, each with the text that stands in it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from ...ros.idl.names import integer_bounds
from .message_types import (
    FLOATS,
    WHOLE,
    Kind,
    constants_of,
    find_class,
    kinds_of,
    plain,
    read_float,
    read_integer,
)

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
        return None if _same(value, self.default) else value

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
        kind: Kind = Kind(""),  # noqa: B008
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
        return None if _same(values, self.default) else values

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


def _same(one: Any, other: Any) -> bool:
    return one == other or (one != one and other != other)  # not-a-number is none of the two, and no news
