"""Messages as the bytes that go over a real wire (CDR)."""

from typing import Any

from turtle_lesson.ros.interfaces import cdr


def serialize_message(message: Any) -> bytes:
    """The message's CDR bytes, little endian, with their four-byte header."""
    return cdr.serialize(message)


def deserialize_message(serialized_message: bytes, message_type: type) -> Any:
    """The message of CDR bytes; ValueError if they are none."""
    return cdr.deserialize(serialized_message, message_type)
