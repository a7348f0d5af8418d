"""From the type of a field to its class (facts: rosidl_runtime_py/import_message.py)."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from rosidl_parser.definition import NamespacedType


def import_message_from_namespaced_type(message_type: NamespacedType) -> Any:
    """The class that a type such as `NamespacedType(['geometry_msgs', 'msg'], 'Twist')` names.

    Raises ModuleNotFoundError where there is no such package, or it has no such folder, and AttributeError where the
    package has no interface of this name.
    """
    module = import_module(".".join(message_type.namespaces))
    owner, underscore, part = message_type.name.rpartition("_")
    if underscore and part == "FeedbackMessage":
        return getattr(module, owner).Impl.FeedbackMessage
    return getattr(module, message_type.name)
