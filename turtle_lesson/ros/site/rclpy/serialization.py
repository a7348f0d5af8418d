"""Messages as the bytes that go over a real wire (CDR)."""

from typing import Any

from turtle_lesson.ros.idl import cdr, checks

from ._rclpy_pybind11 import RMWError
from .type_support import check_for_type_support


def serialize_message(message: Any) -> bytes:
    """The message's CDR bytes, little endian, with their four-byte header. Raises AttributeError for no message."""
    check_for_type_support(type(message))
    return cdr.serialize(message if checks.when_assigned else checks.sendable(message))


def deserialize_message(serialized_message: bytes, message_type: type) -> Any:
    """The message of CDR bytes. Raises RMWError if they are none, AttributeError for a type that is no message's."""
    check_for_type_support(message_type)
    if not isinstance(serialized_message, bytes):
        raise TypeError(f"the bytes of a message are expected, got {serialized_message!r}")
    try:
        return cdr.deserialize(serialized_message, message_type)
    except ValueError as error:
        raise RMWError(f"failed to deserialize ROS message: {error}") from None
