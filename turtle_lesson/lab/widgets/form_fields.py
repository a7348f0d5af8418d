"""A message as a form has it: a tree of groups, rows and single fields, each with the text that stands in it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

from .message_types import FLOATS, INTEGERS, Kind, constants_of, find_class, kinds_of, limits_of, plain

LARGEST_FLOAT32 = 3.402823466e38

MOST_ROWS = 64
"""More rows than this are no work for a form but for a program."""

TIME = "builtin_interfaces/Time"


class FieldError(ValueError):
    """What stands in a field cannot be sent; the text says why, in words."""


class Single:
    """One value: a number, true or false, or a text. `text` is what stands in the field."""

    def __init__(self, name: str, path: str, kind: Kind, value: Any, constants: dict[str, Any]) -> None:
        self.name, self.path, self.kind = name, path, kind
        self.default = plain(value, kind)
        self.text: str | bool = self.default if isinstance(self.default, (bool, str)) else repr(self.default)
        self.constants = {each: found for each, found in constants.items() if self._fits(found)}

    def value(self) -> Any:
        """The value, as YAML has it. Raises FieldError for what it cannot be."""
        if isinstance(self.text, bool):
            return self.text
        text = self.text.strip().replace("−", "-")
        if text in self.constants:
            return self.constants[text]
        if self.kind.base in FLOATS:
            return _float(text, self.kind.base)
        if self.kind.base in INTEGERS | {"octet", "char"}:
            return _integer(text, *limits_of(self.kind.base))
        if self.kind.longest and len(self.text) > self.kind.longest:
            raise FieldError(f"at most {self.kind.longest} characters fit here, these are {len(self.text)}")
        return self.text

    def build(self, now: Any) -> Any:
        """The value, as the message's field wants it."""
        value = self.value()
        return bytes([value]) if self.kind.base == "octet" else value

    def changed(self) -> Any:
        """The value if it is not the default, else None."""
        value = self.value()
        return None if _same(value, self.default) else value

    def set(self, text: Any) -> None:
        """Put a text into the field; true or false into a checkbox. Raises ValueError for anything else."""
        wanted = bool if isinstance(self.text, bool) else str
        if not isinstance(text, wanted):
            raise ValueError(f"{self.path} takes {'true or false' if wanted is bool else 'a text'}, got {text!r}.")
        self.text = text

    def singles(self) -> Iterator[Single]:
        """All single fields in here: itself."""
        yield self

    def state(self) -> dict[str, Any]:
        """What the browser needs to draw the field."""
        base = self.kind.base
        hint = f"at most {self.kind.longest} characters" if self.kind.longest else ""
        if base in INTEGERS | {"octet", "char"}:
            low, high = limits_of(base)
            hint = f"from {low} to {high}".replace("-", "−")
        control = {"boolean": "checkbox", "string": "text", "wstring": "text"}.get(base, "number")
        return {
            "control": control,
            "path": self.path,
            "name": self.name,
            "type": str(self.kind),
            "help": hint,
            "options": [[name, str(value)] for name, value in self.constants.items()],
        }

    def _fits(self, constant: Any) -> bool:
        if isinstance(constant, bool) or self.kind.base == "boolean":
            return False
        if isinstance(constant, str) or "string" in self.kind.base:
            return isinstance(constant, str) and "string" in self.kind.base
        if self.kind.base in FLOATS:
            return isinstance(constant, float)
        low, high = limits_of(self.kind.base)
        return isinstance(constant, int) and low <= constant <= high


class Group:
    """The fields of one message. If `is_time`, it is a time that can be filled with the moment of sending."""

    def __init__(self, name: str, path: str, message_class: Any, kind: Kind | None = None, message: Any = None) -> None:
        self.name, self.path, self.kind = name, path, kind
        self.message_class = message_class
        self.is_time = kind is not None and kind.base == TIME
        self.now = self.is_time and path.endswith("header/stamp")
        message = message_class() if message is None else message
        constants, kinds = constants_of(message_class), kinds_of(message_class)
        self.parts: dict[str, Part] = {
            each: make_part(each, _join(path, each), found, getattr(message, each), _meant_for(each, kinds, constants))
            for each, found in kinds.items()
        }

    def build(self, now: Any) -> Any:
        """The message. `now` is a function that gives the time as a message."""
        if self.now:
            return now()
        message = self.message_class()
        for name, part in self.parts.items():
            setattr(message, name, part.build(now))
        return message

    def value(self) -> dict[str, Any]:
        """All fields, as YAML has them."""
        return {name: part.value() for name, part in self.parts.items()}

    def changed(self) -> Any:
        """The fields that are not at their defaults, or None. A time that is filled in later is left out."""
        if self.now:
            return None
        found = {name: value for name, part in self.parts.items() if (value := part.changed()) is not None}
        return found or None

    def singles(self) -> Iterator[Single]:
        """All single fields in here, with what is filled in later left out."""
        if not self.now:
            for part in self.parts.values():
                yield from part.singles()

    def state(self) -> dict[str, Any]:
        """What the browser needs to draw the group."""
        control = "time" if self.is_time else "group"
        own = {"control": control, "path": self.path, "name": self.name, "type": str(self.kind or ""), "now": self.now}
        return {**own, "parts": [part.state() for part in self.parts.values()]}


class Rows:
    """An array: a row for each element."""

    def __init__(self, name: str, path: str, kind: Kind, values: Any, constants: dict[str, Any]) -> None:
        self.name, self.path, self.kind, self._constants = name, path, kind, constants
        self._empty = _empty_of(kind)
        values = values.tolist() if hasattr(values, "tolist") else values  # numpy's numbers are not Python's
        self.rows = [self._row(number, value) for number, value in enumerate(values)]
        self.default = [row.value() for row in self.rows]

    @property
    def why_full(self) -> str:
        """Why there can be no more rows; "" if there can."""
        if self.kind.array == "fixed":
            return f"always {self.kind.size}"
        if self.kind.array == "bounded" and len(self.rows) >= self.kind.size:
            return f"at most {self.kind.size}"
        return f"a form takes at most {MOST_ROWS}; a program, more" if len(self.rows) >= MOST_ROWS else ""

    def add(self) -> None:
        """Add a row at the end. Raises ValueError if there can be no more."""
        if self.why_full:
            raise ValueError(f"{self.path} can have no more rows: {self.why_full}.")
        self.rows.append(self._row(len(self.rows), self._empty()))

    def remove(self, number: int) -> None:
        """Take a row away; those below move up."""
        if self.kind.array == "fixed" or not isinstance(number, int) or not 0 <= number < len(self.rows):
            raise ValueError(f"{self.path} has no row {number!r} to remove.")
        del self.rows[number]
        for at, row in enumerate(self.rows):
            _move(row, _join(self.path, str(at)))
            row.name = str(at)

    def build(self, now: Any) -> list[Any]:
        """The values, as the message's field wants them."""
        return [row.build(now) for row in self.rows]

    def value(self) -> list[Any]:
        """The values, as YAML has them."""
        return [row.value() for row in self.rows]

    def changed(self) -> Any:
        """The values if they are not the default, or None."""
        if self.kind.is_message:
            values = [row.changed() or {} for row in self.rows]
            return values if len(values) != len(self.default) or any(values) else None
        values = self.value()
        return None if _same(values, self.default) else values

    def singles(self) -> Iterator[Single]:
        """All single fields in here."""
        for row in self.rows:
            yield from row.singles()

    def state(self) -> dict[str, Any]:
        """What the browser needs to draw the rows."""
        own = {"control": "rows", "path": self.path, "name": self.name, "type": str(self.kind)}
        rows = [row.state() for row in self.rows]
        return {**own, "parts": rows, "full": self.why_full, "fixed": self.kind.array == "fixed"}

    def _row(self, number: int, value: Any) -> Part:
        path = _join(self.path, str(number))
        return make_part(str(number), path, self.kind.element, value, self._constants)


Part = Single | Group | Rows


def make_part(name: str, path: str, kind: Kind, value: Any, constants: dict[str, Any]) -> Part:
    """The part of a form for a field of this kind, with this value in it."""
    if kind.array:
        return Rows(name, path, kind, value, constants)
    if kind.is_message:
        return Group(name, path, find_class(kind.base), kind, value)
    return Single(name, path, kind, value, constants)


def find_part(whole: Group, path: str) -> Part:
    """The part at a path such as "linear/x" or "points/0/y". Raises ValueError if there is none."""
    found: Part = whole
    for step in path.split("/"):
        inner = found.parts if isinstance(found, Group) else {}
        if isinstance(found, Rows):
            inner = {str(number): row for number, row in enumerate(found.rows)}
        if step not in inner:
            raise ValueError(f"This form has no field {path!r}.")
        found = inner[step]
    return found


def _move(part: Part, path: str) -> None:
    """Give a part and all in it another path."""
    part.path = path
    if isinstance(part, Rows):
        for number, row in enumerate(part.rows):
            _move(row, _join(path, str(number)))
    elif isinstance(part, Group):
        for name, each in part.parts.items():
            _move(each, _join(path, name))


def _join(path: str, name: str) -> str:
    return f"{path}/{name}" if path else name


def _empty_of(kind: Kind) -> Callable[[], Any]:
    """What makes the value of a new row."""
    if kind.is_message:
        return find_class(kind.base)
    if "string" in kind.base:
        return str
    return {"boolean": bool, "float": float, "double": float}.get(kind.base, int)


def _meant_for(field: str, kinds: dict[str, Kind], constants: dict[str, Any]) -> dict[str, Any]:
    """The constants that a field may be set to. A type does not say which belong to which field: their names may.

    Constants that begin with a field's name (POWER_SUPPLY_STATUS_FULL) are that field's alone.
    """
    prefix = {name: f"{name.upper()}_" for name in kinds}
    own = {name: value for name, value in constants.items() if name.startswith(prefix[field])}
    if own:
        return own
    taken = [each for name, each in prefix.items() if any(constant.startswith(each) for constant in constants)]
    return {name: value for name, value in constants.items() if not name.startswith(tuple(taken))}


def _same(one: Any, other: Any) -> bool:
    return one == other or (one != one and other != other)  # not-a-number is none of the two, and no news


def _float(text: str, base: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise FieldError(_no_number(text, "a number such as 1.5")) from None
    if base == "float" and math.isfinite(value) and abs(value) > LARGEST_FLOAT32:
        raise FieldError("a float32 goes up to 3.4e38")
    return value


def _integer(text: str, low: int, high: int) -> int:
    try:
        value = int(text)
    except ValueError:
        raise FieldError(_no_number(text, "a whole number such as 3")) from None
    if not low <= value <= high:
        raise FieldError(f"a whole number from {low} to {high} fits here, not {value}".replace("-", "−"))
    return value


def _no_number(text: str, wanted: str) -> str:
    if not text:
        return f"{wanted} is missing"
    shown = text if len(text) <= 30 else f"{text[:30]}…"
    return f'{wanted} is wanted, got "{shown}"' + (": write a point, not a comma" if "," in text else "")
