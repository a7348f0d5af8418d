"""CDR: the bytes of a message as ROS 2 sends and records them, little endian with the 4-byte header.

`rosbags` does the work. It reads the attributes of any object, if arrays are numpy arrays and bytes are
numbers, so each message is shown to it as a plain portrait of itself; what it reads goes straight into our
own classes. What it does not know is described at the end.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable
from functools import cache
from math import isqrt
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

from .checks import TYPE_CODES, numpy_name
from .model import FieldType
from .names import STRINGS

if TYPE_CHECKING:
    pass


# What DDS puts into a message without fields (rosidl_generator_c, EMPTY_STRUCTURE_REQUIRED_MEMBER_NAME).
PLACEHOLDER = "structure_needs_at_least_one_member"

_names: WeakKeyDictionary[type, str] = WeakKeyDictionary()


def serialize(message: Any) -> bytes:
    """The CDR bytes of a message, or of a service's request or response.

    Raises TypeError where the object is no message of a generated class, and ValueError where the message holds what
    CDR cannot carry, such as half a character or a list that is too long.
    """
    if isinstance(message, type):
        raise TypeError(f"expected a message, got the class {message.__name__}")
    name = _name(type(message))
    try:
        return bytes(_store().serialize_cdr(_portrait(message), name, little_endian=True))
    except Exception as error:
        raise ValueError(f"this {message._TYPE_NAME} cannot be written as CDR: {error}") from error


def deserialize(data: bytes | bytearray | memoryview, message_class: Any) -> Any:
    """The message of a class that CDR bytes hold, little or big endian, with their 4-byte header.

    Raises TypeError where the class is none of a message, and ValueError where the bytes are cut short, too long or no such
    message.
    """
    name = _name(message_class)
    try:
        return _store().deserialize_cdr(bytes(data), name)
    except Exception as error:
        reason = str(error).replace(name, message_class._TYPE_NAME).rstrip(".")
        raise ValueError(
            f"these {len(data)} bytes are not a message of type {message_class._TYPE_NAME} (cut short, or written with another"
            f" definition?): {reason}"
        ) from error


@cache
def _store() -> Any:
    from rosbags.typesys.store import Typestore

    store: Any = Typestore()
    store.fielddefs[WIDE] = ((), [("units", wide_string())])
    store.types[WIDE] = from_units
    return store


def _name(message_class: Any) -> str:
    """The name under which rosbags knows a class; each class has its own, since definitions change."""
    if not isinstance(message_class, type) or not hasattr(message_class, "_wire_copy"):
        hint = "; of a service, give .Request or .Response" if hasattr(message_class, "Request") else ""
        raise TypeError(f"expected a message class, got {message_class!r}{hint}")
    if message_class not in _names:
        _names[message_class] = _register(message_class)
    return _names[message_class]


def _register(message_class: Any) -> str:
    members = message_class._DEFINITION.fields
    kinds = message_class._KINDS
    fields: list[Any] = [
        (member.name, _description(member.type, kind.element_class))
        for member, kind in zip(members, kinds, strict=True)
    ]
    store: Any = _store()
    name = f"{message_class._TYPE_NAME}#{len(store.types)}"
    store.fielddefs[name] = ((), fields or [(PLACEHOLDER, base("uint8"))])
    store.types[name] = _maker(message_class)
    return name


def _description(type_: FieldType, element_class: Any) -> Any:
    """rosbags' description of a type."""
    from rosbags.interfaces import Nodetype

    if type_.base == "wstring":
        element = named(WIDE) if type_.is_array else wide_string()
    elif type_.is_primitive:
        element = base("uint8" if type_.base in ("byte", "char") else type_.base)
    else:
        element = named(_name(element_class))
    if not type_.is_array:
        return element
    if type_.is_fixed and type_.size is not None:
        return long_array(_store(), element, type_.size) if _is_long(type_) else array_of(element, type_.size)
    return Nodetype.SEQUENCE, (element, type_.size or 0)


def _is_long(type_: FieldType) -> bool:
    """Whether an array is told in parts."""
    return type_.is_fixed and (type_.size or 0) > LONGEST and (not type_.is_primitive or type_.base in STRINGS)


def _portrait(message: Any) -> SimpleNamespace:
    fields = message._DEFINITION.fields
    if not fields:
        return SimpleNamespace(**{PLACEHOLDER: 0})
    return SimpleNamespace(**{each.name: _shown(getattr(message, each.name), each.type) for each in fields})


def _shown(value: Any, type_: FieldType) -> Any:
    import numpy

    if not type_.is_array:
        if not type_.is_primitive:
            return _portrait(value)
        if type_.base == "wstring":
            return to_units(value)
        return value[0] if type_.base == "byte" else value
    if type_.is_bounded and type_.size is not None and len(value) > type_.size:
        raise ValueError(f"{len(value)} elements in a sequence of at most {type_.size}")
    if not type_.is_primitive or type_.base in STRINGS:
        shown = _shown_elements(value, type_)
        return in_parts(shown) if _is_long(type_) else shown
    if type_.base == "byte":
        return numpy.frombuffer(b"".join(value), "uint8")
    if type_.base == "bool":
        return numpy.array(list(value), "bool")
    return numpy.asarray(value, numpy_name(type_.base)).ravel()


def _shown_elements(values: Any, type_: FieldType) -> list[Any]:
    if not type_.is_primitive:
        return [_portrait(each) for each in values]
    return [SimpleNamespace(units=to_units(each)) for each in values] if type_.base == "wstring" else list(values)


def _maker(message_class: Any) -> Callable[..., Any]:
    """A function that makes a message of the values that rosbags has read, in the order of the fields."""
    readers = [("_" + member.name, _reader(member.type)) for member in message_class._DEFINITION.fields]

    def make(*values: Any) -> Any:
        message = object.__new__(message_class)
        for (slot, read), value in zip(readers, values, strict=False):
            setattr(message, slot, value if read is None else read(value))
        return message

    return make


def _reader(type_: FieldType) -> Callable[[Any], Any] | None:
    if not type_.is_array:
        return (lambda value: bytes([value])) if type_.base == "byte" else _text_reader(type_)
    if type_.base == "byte":
        return lambda values: _limited([bytes([each]) for each in values], type_)
    if type_.base == "bool":
        return lambda values: _limited(values.tolist(), type_)
    if not type_.is_primitive or (type_.string_bound is None and type_.base in STRINGS):
        return lambda values: _limited(values, type_)
    if type_.string_bound is not None:
        check = _bounded_text(type_.string_bound)
        return lambda values: _limited([check(each) for each in values], type_)
    if type_.is_fixed:
        return lambda values: values.copy()
    code = TYPE_CODES[type_.base]
    return lambda values: _limited(array(code, values.tobytes()), type_)


def _text_reader(type_: FieldType) -> Callable[[Any], str] | None:
    check = None if type_.string_bound is None else _bounded_text(type_.string_bound)
    if type_.base != "wstring":
        return check
    return from_units if check is None else lambda units: check(from_units(units))


def _bounded_text(bound: int) -> Callable[[str], str]:
    def read(text: str) -> str:
        if len(text) > bound:
            raise ValueError(f"{len(text)} characters in a string of at most {bound}")
        return text

    return read


def _limited(values: Any, type_: FieldType) -> Any:
    if type_.is_bounded and type_.size is not None and len(values) > type_.size:
        raise ValueError(f"{len(values)} elements in a sequence of at most {type_.size}")
    return values


# -- cdr shapes ---------------------------------------------------------------------------------------------------
# What rosbags does not know, as something that it knows and that has the same bytes: wide strings, and long fixed
# arrays.
# A wide string is on the wire of Humble's Fast DDS the number of its UTF-16 units and then each unit in four bytes
# (facts: rosidl_typesupport_fastrtps_cpp, Fast-CDR 1). A fixed array of strings or messages is a line of code per
# element in what rosbags writes for itself, so a long one is told as one of arrays.

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
