"""CDR: the bytes of a message as ROS 2 sends and records them, little endian with a 4-byte header.

Facts: the OMG's XCDR1, as Fast-CDR 1 and rosidl_typesupport_fastrtps_cpp of Humble write it. A number lies at a multiple of its
size; a string is its length with the closing zero, and its UTF-8; a wide string is the number of its UTF-16 units, each in
four bytes; a sequence is its length and its elements; a message without fields is one byte.
"""

from __future__ import annotations

import struct
from array import array
from collections.abc import Callable
from typing import Any

from .checks import TYPE_CODES, numpy_name
from .model import FieldType

HEADER = b"\0\1\0\0"
"""Plain CDR, little endian, as are all computers that ROS 2 is made for."""

CODES = {**TYPE_CODES, "bool": "?", "byte": "c"}
"""What `struct` calls the types."""


class _Input:
    """The bytes of a message, which are taken one after the other."""

    def __init__(self, data: bytes) -> None:
        if len(data) < len(HEADER):
            raise ValueError("the header is missing")
        if not data[1] & 1:
            raise ValueError("big endian numbers are not read here")
        self._body = memoryview(data)[len(HEADER) :]
        self._place = 0

    def take(self, count: int, size: int = 1) -> memoryview:
        """The next so many values of a size."""
        if count == 0:
            return self._body[:0]
        start = self._place + -self._place % size
        self._place = start + count * size
        if self._place > len(self._body):
            raise ValueError(f"{self._place - len(self._body)} bytes are missing")
        return self._body[start : self._place]

    def numbers(self, code: str, count: int) -> array[Any]:
        """The next so many numbers."""
        found = array(code)
        found.frombytes(self.take(count, found.itemsize))
        return found

    def end(self) -> None:
        """Raise ValueError if there are more bytes than what may fill up a block of four."""
        if len(self._body) - self._place > 3:
            raise ValueError(f"{len(self._body) - self._place} bytes are left over")


Write = Callable[[bytearray, Any], None]
Read = Callable[[_Input], Any]
Codec = tuple[Write, Read]
"""Writes a value behind what is written already, and reads it."""


def serialize(message: Any) -> bytes:
    """The CDR bytes of a message, or of a service's request or response.

    Raises TypeError where the object is no message of a generated class, and ValueError where the message holds what
    CDR cannot carry, such as half a character or a list that is too long.
    """
    if isinstance(message, type):
        raise TypeError(f"expected a message, got the class {message.__name__}")
    write, _ = _codec(type(message))
    body = bytearray()
    try:
        write(body, message)
    except Exception as error:
        raise ValueError(f"this {message._TYPE_NAME} cannot be written as CDR: {error}") from error
    return HEADER + body


def deserialize(data: bytes | bytearray | memoryview, message_class: Any) -> Any:
    """The message of a class that CDR bytes hold, with their 4-byte header.

    Raises TypeError where the class is none of a message, and ValueError where the bytes are cut short, too long or no such
    message.
    """
    _, read = _codec(message_class)
    try:
        source = _Input(bytes(data))
        message = read(source)
        source.end()
    except Exception as error:
        raise ValueError(
            f"these {len(data)} bytes are not a message of type {message_class._TYPE_NAME} (cut short, or written with another"
            f" definition?): {error}"
        ) from error
    return message


def _codec(message_class: Any) -> Codec:
    """How messages of a class are written and read; each class keeps its own."""
    if not isinstance(message_class, type) or not hasattr(message_class, "_wire_copy"):
        hint = "; of a service, give .Request or .Response" if hasattr(message_class, "Request") else ""
        raise TypeError(f"expected a message class, got {message_class!r}{hint}")
    known: Codec | None = message_class.__dict__.get("_CODEC")
    if known is not None:
        return known
    fields = [
        (f"_{kind.name}", *(_array if kind.member.type.is_array else _single)(kind.member.type, kind.element_class))
        for kind in message_class._KINDS  # type: ignore[attr-defined]
    ]

    def write(body: bytearray, message: Any) -> None:
        for slot, put, _ in fields:
            put(body, getattr(message, slot))
        if not fields:
            body.append(0)

    def read(source: _Input) -> Any:
        message: Any = object.__new__(message_class)
        for slot, _, get in fields:
            setattr(message, slot, get(source))
        if not fields:
            source.take(1)
        return message

    message_class._CODEC = write, read  # type: ignore[attr-defined]
    return write, read


def _single(type_: FieldType, element_class: type | None) -> Codec:
    """How one value of a type is written and read, or an element of an array."""
    if element_class is not None:
        return _codec(element_class)
    if type_.base in CODES:
        return _number(CODES[type_.base])
    put_length, get_length = _number("I")
    bound, is_wide = type_.string_bound, type_.base == "wstring"

    def write(body: bytearray, text: str) -> None:
        if is_wide:
            units = array("I", array("H", text.encode("utf-16-le")))
            put_length(body, len(units))
            body += units.tobytes()
        else:
            letters = text.encode() + b"\0"
            put_length(body, len(letters))
            body += letters

    def read(source: _Input) -> str:
        length = get_length(source)
        if is_wide:
            text = array("H", source.numbers("I", length)).tobytes().decode("utf-16-le")
        else:
            text = str(source.take(length)[:-1], "utf-8")
        if bound is not None and len(text) > bound:
            raise ValueError(f"{len(text)} characters in a string of at most {bound}")
        return text

    return write, read


def _number(code: str) -> Codec:
    number = struct.Struct(f"<{code}")
    size, pack, unpack = number.size, number.pack, number.unpack

    def write(body: bytearray, value: Any) -> None:
        body += bytes(-len(body) % size) + pack(value)

    def read(source: _Input) -> Any:
        return unpack(source.take(1, size))[0]

    return write, read


def _array(type_: FieldType, element_class: type | None) -> Codec:
    """How an array or sequence is written and read."""
    put_length, get_length = _number("I")
    put, get = _single(type_, element_class)
    code, lengths = TYPE_CODES.get(type_.base), type_.lengths
    size = array(code or "b").itemsize

    def check(length: int) -> None:
        if length not in lengths:
            raise ValueError(f"{length} elements in {type_}")

    def write(body: bytearray, values: Any) -> None:
        if code is None or not type_.is_fixed:  # an array of numpy keeps its size, in whatever shape
            check(len(values))
        if not type_.is_fixed:
            put_length(body, len(values))
        if code is None:
            for value in values:
                put(body, value)
        elif numbers := values.tobytes():
            body += bytes(-len(body) % size) + numbers

    def read(source: _Input) -> Any:
        length = type_.size if type_.is_fixed and type_.size is not None else get_length(source)
        check(length)
        if code is None:
            return [get(source) for _ in range(length)]
        found = source.numbers(code, length)
        if not type_.is_fixed:
            return found
        import numpy

        return numpy.frombuffer(found, numpy_name(type_.base))

    return write, read
