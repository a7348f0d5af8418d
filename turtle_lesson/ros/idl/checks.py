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
from collections import UserString
from collections.abc import Callable, Sequence, Set
from math import isfinite
from struct import Struct
from typing import Any

from .model import FieldType, Plain
from .names import FLOATS, bounds

Check = Callable[[Any], Any]

when_assigned = True
"""Whether values are checked when they are assigned; a world sets it when it opens."""

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
    for kind in type(message)._KINDS:
        value, type_ = getattr(message, f"_{kind.name}"), kind.member.type
        if not type_.is_array and type_.base in FLOATS and isinstance(value, int):
            value = float(value)
        try:
            value = kind.objects[kind.check].__wrapped__(value)
        except AssertionError as error:
            refused = TypeError(str(error))
            for note in (*getattr(error, "__notes__", ()), "Since ROS 2 Iron this is found when the message is sent."):
                refused.add_note(note)
            raise refused from None
        if kind.element_class is not None:
            value = [sendable(each) for each in value] if type_.is_array else sendable(value)
        setattr(new, f"_{kind.name}", value)
    return new


def shown(value: object) -> str:
    """A value and its type in few words."""
    text = repr(value)
    return f"{text if len(text) <= 40 else text[:37] + '...'} ({type(value).__name__})"


ZEROS: dict[str, Plain | bytes] = {"bool": False, "byte": b"\x00", "string": "", "wstring": ""}


def zero(base: str) -> Plain | bytes:
    """What a field of a primitive type holds where the definition gives no default."""
    return ZEROS.get(base, 0.0 if base in FLOATS else 0)


_HINTS = {
    bool: "write True or False",
    bytes: "write b'\\x01' or bytes([1])",
    float: "write a number with a point such as 1.0, or float(...)",
    int: "int(...) or round(...) makes a whole number",
    str: "str(...) makes a text",
}


def scalar_check(name: str, type_: FieldType) -> Check:
    """Check of a field with one primitive value; a float or a byte is stored as a plain one."""
    kind = type(zero(type_.base))
    is_value = _value_test(type_, (bytes, bytearray) if kind is bytes else kind)
    made_plain = kind in (float, bytes)

    def check(value: Any) -> Any:
        if is_value(value) and (kind is not bytes or len(value) == 1):
            return kind(value) if made_plain else value
        is_kind = isinstance(value, kind)
        wanted = f"of type '{kind.__name__}'"
        if kind is bytes:
            wanted = "of type 'bytes' or 'ByteString' with length 1"
        elif type_.string_bound is not None:
            wanted = f"string value not longer than {type_.string_bound}"
        elif is_kind:
            wanted = f"{'a' if kind is float else 'an'} {_range(type_.base)}"
        hint = "" if is_kind else f"; {_HINTS[kind]}"
        raise refusal(f"The '{name}' field must be {wanted}", f"Got {shown(value)}{hint}")

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


def list_check(name: str, type_: FieldType, element_class: type[Any]) -> Check:
    """Check of an array or sequence that is kept as it was given (messages, strings, booleans, bytes)."""
    allowed = {element_class} if type_.string_bound is None and type_.base not in TYPE_CODES else set()
    is_element, lengths = _value_test(type_, element_class), type_.lengths

    def check(value: Any) -> Any:
        fits = (type(value) is list or _is_collection(value)) and len(value) in lengths
        if fits and (set(map(type, value)) <= allowed or all(map(is_element, value))):
            return value
        raise _no_collection(name, type_, element_class, value, is_element)

    return check


def sequence_check(name: str, type_: FieldType) -> Check:
    """Check of a sequence of numbers, stored as `array.array`; one of the right kind is taken as is."""
    code, make, lengths = TYPE_CODES[type_.base], _array_maker(name, type_), type_.lengths

    def check(value: Any) -> array[Any]:
        if not isinstance(value, array):
            return make(value)
        text = f"The '{name}' array.array() must have "
        if value.typecode != code:
            note = f"Got the type code '{value.typecode}'; write array.array('{code}', [...])"
            raise refusal(f"{text}the type code of '{code}'", note)
        if len(value) not in lengths:
            raise refusal(f"{text}a size <= {type_.size}", f"Got a size of {len(value)}")
        return value

    return check


def _array_maker(name: str, type_: FieldType) -> Callable[[Any], array[Any]]:
    """What makes an array of a collection of numbers; raises AssertionError for what is none, or does not fit."""
    code, number, lengths = TYPE_CODES[type_.base], type(zero(type_.base)), type_.lengths
    allowed, check_list = {number}, list_check(name, type_, number)
    # Of bytes, array() would make numbers of several bytes.
    quick = {list, tuple, bytes, bytearray} if code == "B" else {list, tuple}

    def make(value: Any) -> array[Any]:
        if type(value) in quick and len(value) in lengths and set(map(type, value)) <= allowed:
            try:
                if code != "f":
                    return array(code, value)
                packed = Struct(f"={len(value)}f").pack(*value)  # faster than array("f", value), and it finds overflow
                if _LARGEST not in packed:
                    return array(code, packed)
            except OverflowError:
                pass  # each number needs a look
        return array(code, list(check_list(value)))

    return make


def numpy_check(name: str, type_: FieldType) -> Check:
    """Check of a fixed number of numbers, stored as a numpy array; one of the right kind is taken as is."""
    make = _array_maker(name, type_)

    def check(value: Any) -> Any:
        import numpy

        dtype = numpy.dtype(numpy_name(type_.base))
        if not isinstance(value, numpy.ndarray):
            return numpy.array(make(value), dtype)
        if value.dtype != dtype:
            text = f"The '{name}' numpy.ndarray() must have the dtype of 'numpy.{dtype.name}'"
            raise refusal(text, f"Got dtype {value.dtype}; .astype(numpy.{dtype.name}) converts")
        if value.size != type_.size:
            text = f"The '{name}' numpy.ndarray() must have a size of {type_.size}"
            raise refusal(text, f"Got a size of {value.size}")
        return value

    return check


def numpy_name(base: str) -> str:
    """numpy's name of a primitive type: char is a uint8."""
    return "uint8" if base == "char" else base


def _value_test(type_: FieldType, kind: type[Any] | tuple[type[Any], ...]) -> Callable[[Any], bool]:
    """What is true of the values, or elements, of a field."""
    bound = type_.string_bound
    if bound is not None:
        return lambda value: isinstance(value, kind) and len(value) <= bound
    if type_.base not in TYPE_CODES:
        return lambda value: isinstance(value, kind)
    low, high = bounds(type_.base)
    if kind is int:
        return lambda value: isinstance(value, int) and low <= value <= high
    return lambda value: isinstance(value, float) and (low <= value <= high or not isfinite(value))


def _range(base: str, digits: str = "") -> str:
    """`unsigned integer in [0, 255]`."""
    low, high = bounds(base)
    word = {"float32": "float", "float64": "double"}.get(base) or ("integer" if low else "unsigned integer")
    return f"{word} in [{low:{digits}}, {high:{digits}}]"


def _is_collection(value: object) -> bool:
    return isinstance(value, Sequence | Set) and not isinstance(value, str | UserString)


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
    if type_.base in TYPE_CODES:
        words.append(f"and each {_range(type_.base, 'f' if element is float else '')}")
    note = f"Got {shown(value)}" + ("; .tolist() makes a list of it" if hasattr(value, "tolist") else "")
    if _is_collection(value):
        wrong = (f"Element {index} is {shown(each)}" for index, each in enumerate(value) if not is_element(each))
        note = next(wrong, f"Got {len(value)} elements")
    return refusal(" ".join(words), note)
