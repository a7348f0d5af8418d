"""Checks of the values that are assigned to message fields, in the words of Humble's generated classes.

Each function here makes the check of one field: a function that takes a value and returns what to store, or
raises AssertionError. Generated classes test the common case themselves (a float for a float field) and call
these only for the rest. What would help beyond ROS's words is added as a note to the exception
(`BaseException.add_note`), which a traceback shows below the text.

Since Iron a value is stored unchecked unless ROS_PYTHON_CHECK_FIELDS is 1 (rosidl_python, pull request 194). A world that
behaves as such a release sets `when_assigned`; `sendable` then checks a message before it is sent.
"""

from __future__ import annotations

import os
from array import array
from collections import UserList, UserString
from collections.abc import Callable, Collection, Sequence, Set
from math import isinf
from struct import Struct
from typing import Any

from .model import FieldType
from .names import integer_bounds

Check = Callable[[Any], Any]

when_assigned = True
"""Whether values are checked when they are assigned; a world sets it when it opens."""

FLOAT_BOUNDS = {"float32": 3.402823466e38, "float64": 1.7976931348623157e308}
FLOAT_WORDS = {"float32": "float", "float64": "double"}
TYPE_CODES = {
    "float32": "f", "float64": "d", "int8": "b", "uint8": "B", "char": "B", "int16": "h", "uint16": "H", "int32": "i",
    "uint32": "I", "int64": "q", "uint64": "Q",
}  # fmt: skip
# In the bytes of the largest float32, which numbers a little above ROS's bound are rounded to.
_LARGEST = b"\xff\xff\x7f"


def refusal(text: str, note: str = "") -> AssertionError:
    """An AssertionError of ROS's text with a note of ours."""
    error = AssertionError(text)
    if note:
        error.add_note(note)
    return error


def are_on() -> bool:
    """Whether the running program has values checked when they are assigned."""
    return when_assigned or os.environ.get("ROS_PYTHON_CHECK_FIELDS") == "1"


def assigned(check: Check, store: Check | None = None) -> Check:
    """What a generated class does with a value: check it, or only store it, perhaps made into something by `store`."""

    def check_or_store(value: Any) -> Any:
        if when_assigned or are_on():
            return check(value)
        return value if store is None else store(value)

    check_or_store.__wrapped__ = check  # type: ignore[attr-defined]
    return check_or_store


def sendable(message: Any) -> Any:
    """A copy of a message whose fields were not checked when they were assigned, with whole numbers made floats.

    Raises TypeError for a value that cannot be sent.
    """
    new = type(message)._FRESH()
    for member, kind in zip(type(message)._DEFINITION.fields, type(message)._KINDS, strict=True):
        value = getattr(message, f"_{member.name}")
        if not member.type.is_array and member.type.base in FLOAT_BOUNDS and isinstance(value, int):
            value = float(value)
        try:
            value = kind.objects[kind.check].__wrapped__(value)
        except AssertionError as error:
            refused = TypeError(str(error))
            for note in (*getattr(error, "__notes__", ()), "Since ROS 2 Iron this is found when the message is sent."):
                refused.add_note(note)
            raise refused from None
        if kind.message_class is not None:
            value = sendable(value)
        elif kind.element_class is not None:
            value = [sendable(each) for each in value]
        setattr(new, f"_{member.name}", value)
    return new


def shown(value: object) -> str:
    """A value and its type in few words."""
    text = repr(value)
    return f"{text if len(text) <= 40 else text[:37] + '...'} ({type(value).__name__})"


def float_check(name: str, base: str) -> Check:
    """Check of a float32 or float64 field; what is stored is a plain float."""
    bound = FLOAT_BOUNDS[base]

    def check(value: Any) -> float:
        if not isinstance(value, float):
            note = f"Got {shown(value)}; write a number with a point such as 1.0, or float(...)"
            raise refusal(f"The '{name}' field must be of type 'float'", note)
        if abs(value) > bound and not isinf(value):
            raise refusal(f"The '{name}' field must be a {FLOAT_WORDS[base]} in [{-bound}, {bound}]", f"Got {value!r}")
        return float(value)

    return check


def integer_check(name: str, base: str) -> Check:
    """Check of an integer field."""
    low, high = integer_bounds(base)
    article = "an integer" if low else "an unsigned integer"

    def check(value: Any) -> int:
        if not isinstance(value, int):
            note = f"Got {shown(value)}; int(...) or round(...) makes a whole number"
            raise refusal(f"The '{name}' field must be of type 'int'", note)
        if not low <= value <= high:
            raise refusal(f"The '{name}' field must be {article} in [{low}, {high}]", f"Got {value!r}")
        return value

    return check


def bool_check(name: str) -> Check:
    """Check of a bool field."""
    return _as_given(bool, f"The '{name}' field must be of type 'bool'", "write True or False")


def _as_given(kind: type, text: str, hint: str) -> Check:
    """Check of a value that is stored as it is, and has to be of a kind."""

    def check(value: Any) -> Any:
        if not isinstance(value, kind):
            raise refusal(text, f"Got {shown(value)}; {hint}")
        return value

    return check


def byte_check(name: str) -> Check:
    """Check of a byte field: bytes of length 1."""

    def check(value: Any) -> bytes:
        if not (isinstance(value, bytes | bytearray) and len(value) == 1):
            text = f"The '{name}' field must be of type 'bytes' or 'ByteString' with length 1"
            raise refusal(text, f"Got {shown(value)}; write b'\\x01' or bytes([1])")
        return bytes(value)

    return check


def string_check(name: str, bound: int | None) -> Check:
    """Check of a string field, bounded or not."""
    if bound is None:
        return _as_given(str, f"The '{name}' field must be of type 'str'", "str(...) makes a text")

    def check(value: Any) -> str:
        if not (isinstance(value, str | UserString) and len(str(value)) <= bound):
            text = f"The '{name}' field must be string value not longer than {bound}"
            raise refusal(text, f"Got {shown(value)}")
        return str(value) if isinstance(value, UserString) else value

    return check


def message_check(name: str, message_class: type) -> Check:
    """Check of a field that is itself a message."""
    text = f"The '{name}' field must be a sub message of type '{message_class.__name__}'"

    def check(value: Any) -> Any:
        if not isinstance(value, message_class):
            same_name = str(type(value)) == str(message_class)
            stale = "The package was built again since this message was made: import it anew"
            raise refusal(text, stale if same_name else f"Got {shown(value)}")
        return value

    return check


def list_check(name: str, type_: FieldType, element_class: type) -> Check:
    """Check of an array or sequence that is kept as it was given (messages, strings, booleans, bytes)."""
    allowed = {element_class}
    bound = type_.string_bound

    def is_element(value: Any) -> bool:
        known: Any = value if isinstance(value, element_class) else None
        return known is not None and (bound is None or len(known) <= bound)

    def check(value: Any) -> Any:
        if _is_collection(value) and _fits(type_, len(value)):
            if set(map(type, value)) <= allowed and bound is None:
                return value
            if all(map(is_element, value)):
                return value
        raise _no_collection(name, type_, element_class, value, is_element)

    return check


def sequence_check(name: str, type_: FieldType) -> Check:
    """Check of a sequence of numbers, stored as `array.array`; one of the right kind is taken as is."""
    code = TYPE_CODES[type_.base]
    number = float if type_.base in FLOAT_BOUNDS else int
    allowed = {number}
    is_element = _number_test(type_.base)

    def check(value: Any) -> array[Any]:
        if isinstance(value, array):
            text = f"The '{name}' array.array() must have "
            if value.typecode != code:
                note = f"Got the type code '{value.typecode}'; write array.array('{code}', [...])"
                raise refusal(f"{text}the type code of '{code}'", note)
            if not _fits(type_, len(value)):
                raise refusal(f"{text}a size <= {type_.size}", f"Got a size of {len(value)}")
            return value
        if _is_collection(value) and _fits(type_, len(value)):
            quick = _quick_array(code, value) if set(map(type, value)) <= allowed else None
            if quick is not None:
                return quick
            if all(map(is_element, value)):
                return array(code, value)
        raise _no_collection(name, type_, number, value, is_element)

    return check


def numpy_check(name: str, type_: FieldType) -> Check:
    """Check of a fixed number of numbers, stored as a numpy array; one of the right kind is taken as is."""
    number = float if type_.base in FLOAT_BOUNDS else int
    is_element = _number_test(type_.base)

    def check(value: Any) -> Any:
        import numpy

        dtype = numpy.dtype(numpy_name(type_.base))
        if isinstance(value, numpy.ndarray):
            if value.dtype != dtype:
                text = f"The '{name}' numpy.ndarray() must have the dtype of 'numpy.{dtype.name}'"
                raise refusal(text, f"Got dtype {value.dtype}; .astype(numpy.{dtype.name}) converts")
            if value.size != type_.size:
                text = f"The '{name}' numpy.ndarray() must have a size of {type_.size}"
                raise refusal(text, f"Got a size of {value.size}")
            return value
        if _is_collection(value) and len(value) == type_.size and all(map(is_element, value)):
            return numpy.array(list(value), dtype=dtype)
        raise _no_collection(name, type_, number, value, is_element)

    return check


def numpy_name(base: str) -> str:
    """numpy's name of a primitive type: char is a uint8."""
    return "uint8" if base == "char" else base


def _quick_array(code: str, value: Collection[Any]) -> array[Any] | None:
    """The array of plain numbers, or None where a number may be out of bounds and each needs a look."""
    try:
        if code != "f":
            return array(code, value)
        packed = Struct(f"={len(value)}f").pack(*value)  # faster than array("f", value), and it finds overflow
    except OverflowError:
        return None
    return None if _LARGEST in packed else array(code, packed)


def _number_test(base: str) -> Callable[[Any], bool]:
    if base in FLOAT_BOUNDS:
        bound = FLOAT_BOUNDS[base]
        return lambda value: isinstance(value, float) and (not abs(value) > bound or isinf(value))
    low, high = integer_bounds(base)
    return lambda value: isinstance(value, int) and low <= value <= high


def _is_collection(value: object) -> bool:
    if type(value) in (list, tuple):
        return True
    return isinstance(value, Sequence | Set | UserList) and not isinstance(value, str | UserString)


def _fits(type_: FieldType, length: int) -> bool:
    if type_.size is None:
        return True
    return length == type_.size if type_.is_fixed else length <= type_.size


def _no_collection(
    name: str, type_: FieldType, element: type, value: Any, is_element: Callable[[Any], bool]
) -> AssertionError:
    """The refusal of a collection, with what is wrong: its kind, one of its elements, or else its length."""
    words = [f"The '{name}' field must be a set or sequence"]
    if type_.size is not None:
        words.append(f"with length {type_.size}" if type_.is_fixed else f"with length <= {type_.size}")
    if type_.string_bound is not None:
        words.append(f"and each string value not longer than {type_.string_bound}")
    words.append(f"and each value of type '{element.__name__}'")
    if type_.base in FLOAT_BOUNDS:
        bound = FLOAT_BOUNDS[type_.base]
        words.append(f"and each {FLOAT_WORDS[type_.base]} in [{-bound:f}, {bound:f}]")
    elif type_.base in TYPE_CODES:
        low, high = integer_bounds(type_.base)
        words.append(f"and each {'integer' if low else 'unsigned integer'} in [{low}, {high}]")
    note = f"Got {shown(value)}" + ("; .tolist() makes a list of it" if hasattr(value, "tolist") else "")
    if _is_collection(value):
        wrong = (f"Element {index} is {shown(each)}" for index, each in enumerate(value) if not is_element(each))
        note = next(wrong, f"Got {len(value)} elements")
    return refusal(" ".join(words), note)
