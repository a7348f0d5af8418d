"""The values in content filters: fields and constants, and how they are compared.

They are compared as Fast DDS does it (DDSFilterFactory.cpp, DDSFilterValue.cpp): what holds float32 on one side and no
float64 on the other is compared as float32, and NaN counts as equal to everything.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable
from ctypes import c_float
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from ._filter_language import FilterError
from ._mistakes import did_you_mean

Predicate = Callable[[Any], bool]
Getter = Callable[[Any], Any]

OPERATORS: dict[str, Callable[[int, int], bool]] = {
    "=": operator.eq,
    "<>": operator.ne,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
KINDS = {"bool": "bool", "float32": "float32", "float64": "float64", "string": "text"}
"""What the values of a type are; all others are integers."""
CASTS: dict[str, Callable[[Any], Any]] = {"bool": bool, "float32": float, "float64": float, "text": str, "int": int}
WORDS = {"bool": "a bool", "int": "an integer", "text": "a text", "real": "a number"}
STEP = re.compile(r"(\w+)(?:\[(\d+)\])?")


@dataclass(frozen=True, slots=True)
class Value:
    """An operand: of which kind, how to get it from a message, and how one says it. `constant` if it is no field."""

    kind: str
    get: Getter
    words: str
    constant: Any = None


def constant_of(value: bool | int | float | str, prefix: str = "") -> Value:
    """A value that is the same for all messages."""
    kind = {bool: "bool", int: "int", float: "real", str: "text"}[type(value)]
    return Value(kind, lambda message: value, f"{prefix}{value!r}", value)


def field_of(message_class: Any, path: str) -> Value:
    """A field of a message. Raises FilterError where there is none, or none with a value of its own."""
    steps: list[tuple[str, int | None]] = []
    here, base = message_class, ""
    for name, index in STEP.findall(path):
        if here is None:
            raise FilterError(f"{path!r}: a {base} has no fields, and so no {name!r}")
        member = next((each for each in here._DEFINITION.fields if each.name == name), None)
        if member is None:
            known = [each.name for each in here._DEFINITION.fields]
            hint = did_you_mean(name, known) or f"; it has {', '.join(known) or 'none'}"
            raise FilterError(f"{here._TYPE_NAME} has no field {name!r}{hint}")
        _check_index(member, index)
        steps.append((name, int(index) if index else None))
        here = next(kind.element_class for kind in here._KINDS if kind.name == name)
        base = member.type.base
    if here is not None:
        first = here._DEFINITION.fields[0].name if here._DEFINITION.fields else "x"
        raise FilterError(f"{path!r} is a whole {here._TYPE_NAME}: name one of its fields, such as {path}.{first}")
    if base == "wstring":
        raise FilterError(f"{path!r} is a wstring, which no filter can compare")
    kind = KINDS.get(base, "int")
    return Value(kind, _getter(steps, ord if base == "byte" else CASTS[kind]), f"{path!r}")


def _check_index(member: Any, index: str) -> None:
    type_, name = member.type, member.name
    if type_.is_array and not index:
        raise FilterError(f"{name!r} is {type_}: say which of its values, such as {name}[0]")
    if index and not type_.is_array:
        raise FilterError(f"{name!r} is one {type_}, and so has no [{index}]")
    if index and type_.size is not None and int(index) >= type_.size:
        raise FilterError(f"{name!r} is {type_}: there is no [{index}], the last one is [{type_.size - 1}]")


def _getter(steps: list[tuple[str, int | None]], cast: Callable[[Any], Any]) -> Getter:
    if all(index is None for _, index in steps):
        path = operator.attrgetter(".".join(name for name, _ in steps))
        return lambda message: cast(path(message))

    def get(message: Any) -> Any:
        for name, index in steps:
            message = getattr(message, name)
            if index is not None:
                message = message[index]
        return cast(message)

    return get


def compared(left: Value, sign: str, right: Value) -> Predicate:
    """The predicate of `left sign right`. Raises FilterError for what cannot be compared."""
    kinds = {left.kind, right.kind}
    if ("text" in kinds and len(kinds) > 1) or ("bool" in kinds and kinds & {"real", "float32", "float64"}):
        raise FilterError(
            f"{left.words} is {words_of(left.kind)} and {right.words} is {words_of(right.kind)}: they cannot be compared"
        )
    if "float64" not in kinds and kinds & {"float32", "real"}:
        left, right = _as_float32(left), _as_float32(right)
    decide, one, other = OPERATORS[sign], left.get, right.get

    def compare(message: Any) -> bool:
        a, b = one(message), other(message)
        return decide((a > b) - (a < b), 0)

    return compare


def words_of(kind: str) -> str:
    """What one calls a value of some kind."""
    return WORDS.get(kind, f"a {kind}")


def _as_float32(value: Value) -> Value:
    if value.kind == "float32":
        return value  # a message's are rounded on their way
    get = value.get
    if value.constant is not None:
        rounded = c_float(value.constant).value
        return replace(value, get=lambda message: rounded)
    return replace(value, get=lambda message: c_float(get(message)).value)


def matched(left: Value, word: str, right: Value) -> Predicate:
    """The predicate of `left LIKE right` and `left MATCH right`. Raises FilterError for a pattern that is none."""
    make = _wildcards if word == "LIKE" else _regular
    if right.constant is not None:
        fits = make(right.constant).fullmatch
        return lambda message: fits(left.get(message)) is not None
    return lambda message: make(right.get(message)).fullmatch(left.get(message)) is not None


@lru_cache(64)
def _wildcards(pattern: str) -> re.Pattern[str]:
    """The regular expression of a pattern with % (or *) for any characters, and _ (or ?) for one."""
    parts = ["".join("." if each in "_?" else re.escape(each) for each in part) for part in re.split("[%*]+", pattern)]
    if len(parts) == 1:
        return re.compile(parts[0])
    between = "".join(f"(?>.*?{part})" for part in parts[1:-1])  # never tried anew, so that it takes no time
    return re.compile(f"{parts[0]}{between}.*{parts[-1]}")


@lru_cache(64)
def _regular(pattern: str) -> re.Pattern[str]:
    try:
        return re.compile(pattern)
    except (re.error, OverflowError, RecursionError) as error:
        raise FilterError(f"{pattern!r} is not a regular expression: {error}") from None
