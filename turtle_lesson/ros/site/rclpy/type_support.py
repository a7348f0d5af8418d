"""Checks that a type is what it should be: a message, or a service."""

from __future__ import annotations

from typing import Any, TypeVar

from turtle_lesson.ros.idl.names import without_part

MsgT = TypeVar("MsgT")
SrvT = TypeVar("SrvT")
SrvRequestT = TypeVar("SrvRequestT")
SrvResponseT = TypeVar("SrvResponseT")
SrvEventT = TypeVar("SrvEventT")
"""Type variables for hints, as newer releases have them."""


def check_for_type_support(msg_or_srv_type: Any) -> None:
    """Raise AttributeError for anything that is no ROS 2 interface."""
    if not hasattr(msg_or_srv_type, "_TYPE_SUPPORT"):
        name = getattr(msg_or_srv_type, "__name__", type(msg_or_srv_type).__name__)
        raise AttributeError(
            f"type object {name!r} has no attribute '_TYPE_SUPPORT': a message or service class is expected here, "
            f"such as geometry_msgs.msg.Twist, but {msg_or_srv_type!r} came"
        )


def check_is_valid_msg_type(msg_type: Any) -> None:
    """Raise RuntimeError for a service or action type."""
    check_for_type_support(msg_type)
    if "/msg/" not in msg_type._TYPE_NAME and not hasattr(msg_type, "get_fields_and_field_types"):
        raise RuntimeError(f"The message type provided is not valid ({msg_type}), this might be a service or action")


def check_is_valid_srv_type(srv_type: Any) -> None:
    """Raise RuntimeError for a message or action type."""
    check_for_type_support(srv_type)
    if not hasattr(srv_type, "Request") or not hasattr(srv_type, "Response"):
        raise wrong_kind("service", srv_type, "a message or action")


def wrong_kind(what: str, given: Any, others: str) -> RuntimeError:
    """The error for an interface of another kind, with a note if it is only a part of one, such as a request."""
    error = RuntimeError(f"The {what} type provided is not valid ({given}), this might be {others}")
    name = getattr(given, "__name__", "")
    if (whole := without_part(name)) != name:
        error.add_note(f"{name.replace('_', '.')} is only a part of {whole}.")
    return error
