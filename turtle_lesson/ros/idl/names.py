"""Names in interface definitions: ROS's rules, and what to suggest where one is broken.

The patterns are those of `rosidl_adapter.parser`; the Python module names those of `rosidl_generator_py`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from difflib import get_close_matches

from .model import InvalidDefinition

LOWER_CASE = re.compile(r"^(?!.*__)(?!.*_$)[a-z][a-z0-9_]*$")
MESSAGE = re.compile(r"^[A-Z][A-Za-z0-9]*$")
CONSTANT = re.compile(r"^[A-Z]([A-Z0-9_]?[A-Z0-9]+)*$")
PART_SUFFIXES = ("_Request", "_Response", "_Goal", "_Result", "_Feedback")

INTEGERS = ("int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64")
FLOATS = ("float32", "float64")
STRINGS = ("string", "wstring")
PRIMITIVES = ("bool", "byte", "char", *FLOATS, *INTEGERS, *STRINGS, "duration", "time")

_FROM_OTHER_LANGUAGES = {
    "float": "float32", "double": "float64", "int": "int32", "uint": "uint32", "long": "int64", "short": "int16",
    "octet": "byte", "str": "string", "boolean": "bool",
}  # fmt: skip
_WORD_START = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=.)(?=[A-Z][a-z])")


def bounds(base: str) -> tuple[float, float]:
    """Smallest and largest value of a type of numbers (of floats: finite one); byte (IDL's octet) and char count as uint8."""
    if base in FLOATS:
        largest = 3.402823466e38 if base == "float32" else 1.7976931348623157e308
        return -largest, largest
    if base in ("byte", "octet", "char"):
        return 0, 255
    unsigned = base.startswith("u")
    bits = int(base[4 if unsigned else 3 :])
    return (0, 2**bits - 1) if unsigned else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)


def module_name(name: str) -> str:
    """Python module of an interface: `TurtleStatus` is in `_turtle_status`, `UInt8` in `_u_int8`."""
    return "_" + _WORD_START.sub("_", name).lower()


def without_part(name: str) -> str:
    """The interface that a service's or action's part belongs to: `Spawn_Request` gives `Spawn`."""
    stem, underscore, part = name.rpartition("_")
    return stem if underscore + part in PART_SUFFIXES else name


def check(what: str, name: str) -> None:
    """Raise InvalidDefinition unless this may be the name of a package, message (service, action), field or constant."""
    pattern = {"message": MESSAGE, "constant": CONSTANT}.get(what, LOWER_CASE)
    if pattern.fullmatch(without_part(name) if what == "message" else name):
        return
    reason = f"'{name}' is an invalid {what} name. It should have the pattern '{pattern.pattern}'"
    if what == "message":
        hint = _type_hint(name)
    elif what == "constant":
        hint = "Constants are in capitals; a default value is written without '='"
    elif name.endswith((",", ";")):
        hint = "Write one field a line, with nothing after its name but a default value"
    else:
        better = re.sub(r"_+", "_", re.sub(r"\W", "_", module_name(name))).strip("_")
        hint = f"Try '{better}'" if LOWER_CASE.fullmatch(better) else ""
    raise InvalidDefinition(reason, "InvalidResourceName" if what in ("package", "message") else "NameError", hint=hint)


def is_hidden(name: str) -> bool:
    """Whether ROS's tools leave a node, topic or service out of their lists: a part of its name starts with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))


def nearest(name: str, known: Iterable[str], cutoff: float = 0.6, *, exact: bool = False) -> str:
    """The known name that is most like this one, or "" if none is.

    Capitals and outer slashes do not count, unless names are compared `exact`, as they are.
    """
    compared = {each if exact else each.lower().strip("/"): each for each in known}
    close = get_close_matches(name if exact else name.lower().strip("/"), compared, n=1, cutoff=cutoff)
    return compared[close[0]] if close else ""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """`Did you mean 'Twist'?`, or an empty string where no known name is close.

    Names are alike as a whole, and in the parts that differ: `std_msgs/msg/Int8` is not close to `std_msgs/msg/Nope`.
    """
    by_lower_case = {each.lower(): each for each in known}
    for near in get_close_matches(name.lower(), by_lower_case, n=5, cutoff=0.6):
        if _is_close(name.lower(), near):
            return f"Did you mean '{by_lower_case[near]}'?"
    return ""


def _is_close(name: str, known: str) -> bool:
    """Whether one name is the other with some slips, without the leading and trailing parts that both have."""
    mine, other = (re.split(r"[/.]", each.lstrip("-")) for each in (name, known))
    for end in (0, -1):
        while mine and other and mine[end] == other[end]:
            mine.pop(end)
            other.pop(end)
    short, long = sorted(("/".join(mine), "/".join(other)), key=len)
    return long.startswith(short) or long.endswith(short) or 3 * _slips(short, long) <= len(long)


def _slips(one: str, two: str) -> int:
    """How many letters were left out, added, replaced or swapped with their neighbour (optimal string alignment)."""
    before, row = [0], list(range(len(two) + 1))
    for i, letter in enumerate(one, 1):
        before, last, row = row, before, [i]
        for j, other in enumerate(two, 1):
            least = min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (letter != other))
            if i > 1 and j > 1 and (letter, one[i - 2]) == (two[j - 2], other):
                least = min(least, last[j - 2] + 1)
            row.append(least)
    return row[-1]


def _type_hint(name: str) -> str:
    if name in _FROM_OTHER_LANGUAGES:
        return f"Did you mean '{_FROM_OTHER_LANGUAGES[name]}'?"
    near = did_you_mean(name, PRIMITIVES)
    if near:
        return near
    words = "".join(word[:1].upper() + word[1:] for word in re.split(r"\W|_", name))
    return f"Try '{words}'" if MESSAGE.fullmatch(words) else ""
