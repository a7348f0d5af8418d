"""From a type's name as typed, such as `geometry_msgs/Twist`, to its class.

The rules are those of rosidl_runtime_py's get_message and get_service, as recorded from a real one.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from turtle_lesson.ros.interfaces.names import did_you_mean

from .common import CommandError


def message_class(name: str) -> Any:
    """The class of a message. Raises CommandError with the real tool's sentence, and what was meant perhaps."""
    found = _find(name, "msg")
    if found is None or not hasattr(found, "get_fields_and_field_types"):
        raise CommandError("The passed message type is invalid", suggest_type(name, "msg"))
    return found


def service_class(name: str) -> Any:
    """The class of a service. Raises CommandError with the real tool's sentence, and what was meant perhaps."""
    found = _find(name, "srv")
    if found is None:
        raise CommandError("The passed service type is invalid", suggest_type(name, "srv"))
    if not hasattr(found, "Request") or not hasattr(found, "Response"):
        raise CommandError("The passed type is not a service", suggest_type(name, "srv"))
    return found


def _find(name: str, folder: str) -> Any:
    parts = name.split("/")
    if len(parts) == 2:
        parts.insert(1, folder)
    if len(parts) != 3 or not all(part.isidentifier() for part in parts) or parts[1] not in ("msg", "srv", "action"):
        return None
    try:
        return getattr(import_module(".".join(parts[:2])), parts[2])
    except (AttributeError, ImportError):
        return None


def unknown_type(name: str, folder: str) -> str:
    """A line about a type that does not exist, or that was typed in its short form; nothing for one that does."""
    if name.count("/") == 2 and _find(name, folder) is not None:
        return ""
    return f"There is no type '{name}'\n{suggest_type(name, folder)}".rstrip()


def suggest_type(name: str, folder: str) -> str:
    """`Did you mean 'std_msgs/msg/String'?`, or nothing if no type is like that."""
    from turtle_lesson.ros.interfaces import registry

    known = [
        f"{package}/{interface}"
        for package in registry.packages()
        for interface in registry.interface_names(package)
        if interface.startswith(f"{folder}/")
    ]
    package, _, last = name.replace(".", "/").rpartition("/")
    same_name = [each for each in known if each.rpartition("/")[2].lower() == last.lower() and each != name]
    if not package and same_name:
        return f"Did you mean '{sorted(same_name, key=lambda each: not each.startswith('std_'))[0]}'?"
    full = f"{package}/{folder}/{last}" if package and "/" not in package else name
    return did_you_mean(full, [each for each in known if each != name])
