"""From an interface's full name, such as `geometry_msgs/msg/Twist`, to its class.

Names, rules and sentences are those of rosidl_runtime_py/utilities.py. All `get_…` raise ModuleNotFoundError or
AttributeError where there is no such interface, ValueError where it is one of another kind or the name has no package.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rosidl_parser.definition import NamespacedType

from .import_message import import_message_from_namespaced_type


def get_interface(identifier: str) -> Any:
    """The class of a message, service or action by its full name."""
    return import_message_from_namespaced_type(get_namespaced_type(identifier))


def get_message(identifier: str) -> Any:
    """The class of a message: `geometry_msgs/msg/Twist`, or `geometry_msgs/Twist`."""
    return _checked(identifier, "msg", is_message, "a message")


def get_service(identifier: str) -> Any:
    """The class of a service: `std_srvs/srv/Empty`, or `std_srvs/Empty`."""
    return _checked(identifier, "srv", is_service, "a service")


def get_action(identifier: str) -> Any:
    """The class of an action: `turtlesim/action/RotateAbsolute`, or `turtlesim/RotateAbsolute`."""
    return _checked(identifier, "action", is_action, "an action")


def _checked(identifier: str, folder: str, fits: Callable[[Any], bool], what: str) -> Any:
    interface = import_message_from_namespaced_type(get_namespaced_type(identifier, folder))
    if not fits(interface):
        raise ValueError(f"Expected the full name of {what}, got '{identifier}'")
    return interface


def get_namespaced_type(identifier: str, folder: str | None = None) -> NamespacedType:
    """A full name as a type of `rosidl_parser.definition`; the name may lack the `folder`, if one is given."""
    *namespaces, name = identifier.split("/")
    if len(namespaces) == 1 and folder is not None:
        namespaces.append(folder)
    if not namespaces or not namespaces[0]:
        raise ValueError(f"Empty module name: '{identifier}' is not a name such as geometry_msgs/msg/Twist")
    return NamespacedType(namespaces, name)


def is_message(interface: Any) -> bool:
    """Whether a class is one of messages (a request, a response, a goal is one, too)."""
    return hasattr(interface, "SLOT_TYPES")


def is_service(interface: Any) -> bool:
    """Whether a class is that of a service."""
    return hasattr(interface, "Request") and hasattr(interface, "Response")


def is_action(interface: Any) -> bool:
    """Whether a class is that of an action."""
    return hasattr(interface, "Goal") and hasattr(interface, "Result") and hasattr(interface, "Feedback")
