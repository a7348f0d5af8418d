"""What rosbags does not know, as something that it knows and that has the same bytes: wide strings, and long fixed arrays.

A wide string is on the wire of Humble's Fast DDS the number of its UTF-16 units and then each unit in four bytes (facts:
rosidl_typesupport_fastrtps_cpp, Fast-CDR 1). A fixed array of strings or messages is a line of code per element in what
rosbags writes for itself, so a long one is told as one of arrays.
"""

from __future__ import annotations

from math import isqrt
from types import SimpleNamespace
from typing import Any

WIDE = "wide string"
"""The name under which rosbags knows an element of an array of wide strings."""

LONGEST = 64
"""A fixed array with more strings or messages than these is told in parts."""


def base(name: str) -> Any:
    """rosbags' description of a primitive type."""
    from rosbags.interfaces import Nodetype

    return Nodetype.BASE, (name, 0)


def named(name: str) -> Any:
    """rosbags' description of a type that was registered under a name."""
    from rosbags.interfaces import Nodetype

    return Nodetype.NAME, name


def array_of(element: Any, size: int) -> Any:
    """rosbags' description of exactly so many elements."""
    from rosbags.interfaces import Nodetype

    return Nodetype.ARRAY, (element, size)


def wide_string() -> Any:
    """rosbags' description of a wide string."""
    from rosbags.interfaces import Nodetype

    return Nodetype.SEQUENCE, (base("uint32"), 0)


def register_wide_strings(store: Any) -> None:
    """Make elements of arrays of wide strings known to a store of rosbags."""
    store.fielddefs[WIDE] = ((), [("units", wide_string())])
    store.types[WIDE] = from_units


def to_units(text: str) -> Any:
    """The UTF-16 units of a text; UnicodeEncodeError if it holds half a character."""
    import numpy

    return numpy.frombuffer(text.encode("utf-16-le"), "<u2").astype("uint32")


def from_units(units: Any) -> str:
    """The text of some UTF-16 units; ValueError if they are none."""
    if len(units) and units.max() > 0xFFFF:
        raise ValueError("a unit of a wide string is larger than two bytes")
    text: str = units.astype("<u2").tobytes().decode("utf-16-le")
    return text


def long_array(store: Any, element: Any, size: int) -> Any:
    """Description of a long fixed array: equal parts, and what is left over."""
    length = isqrt(size)
    part, whole = f"{length} of {element}", f"{size} of {element}"
    store.fielddefs[part] = ((), [("values", array_of(element, length))])
    store.types[part] = list
    rest = [("rest", array_of(element, size % length))] if size % length else []
    store.fielddefs[whole] = ((), [("parts", array_of(named(part), size // length)), *rest])
    store.types[whole] = _joined
    return named(whole)


def in_parts(values: list[Any]) -> SimpleNamespace:
    """The elements of a long fixed array, as rosbags is to see them."""
    length = isqrt(len(values))
    full = len(values) - len(values) % length
    parts = [SimpleNamespace(values=values[start : start + length]) for start in range(0, full, length)]
    return SimpleNamespace(parts=parts, rest=values[full:])


def _joined(parts: Any, rest: Any = ()) -> list[Any]:
    return [value for part in parts for value in part] + list(rest)
