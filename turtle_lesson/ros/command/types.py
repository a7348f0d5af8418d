"""From a type's name as typed, such as `geometry_msgs/Twist`, to its class, or to a sentence that helps."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from turtle_lesson.ros.interfaces.errors import InvalidDefinition
from turtle_lesson.ros.interfaces.names import did_you_mean
from turtle_lesson.ros.interfaces.registry import FOLDERS, registry

from .common import CommandError


def message_class(name: str) -> Any:
    """The class of a message. Raises CommandError with the real tool's sentence, and what was meant perhaps."""
    from rosidl_runtime_py.utilities import get_message

    found = _find(get_message, name)
    if found is None:
        raise CommandError("The passed message type is invalid", suggest_type(name, "msg"))
    return found


def service_class(name: str) -> Any:
    """The class of a service. Raises CommandError with the real tool's sentence, and what was meant perhaps."""
    from rosidl_runtime_py.utilities import get_interface, get_service

    found = _find(get_service, name)
    if found is None:
        is_other = name.count("/") == 2 and _find(get_interface, name) is not None
        sentence = "The passed type is not a service" if is_other else "The passed service type is invalid"
        raise CommandError(sentence, suggest_type(name, "srv"))
    return found


def action_class(name: str) -> Any:
    """The class of an action. Raises CommandError with the real tool's sentence, and what was meant perhaps."""
    from rosidl_runtime_py.utilities import get_action

    found = _find(get_action, name)
    if found is None:
        raise CommandError("The passed action type is invalid", suggest_type(name, "action"))
    return found


def _find(get: Callable[[str], Any], name: str) -> Any:
    """The class of a name, or None; a definition that is refused says why."""
    parts = name.split("/")
    if len(parts) > 3 or (len(parts) == 3 and parts[1] not in FOLDERS) or not all(map(str.isidentifier, parts)):
        return None
    try:
        return get(name)
    except InvalidDefinition:
        raise
    except (AttributeError, ImportError, ValueError):
        return None


def unknown_type(name: str, folder: str) -> str:
    """A line about a type that does not exist, or that was typed in its short form; nothing for one that does."""
    from rosidl_runtime_py.utilities import get_interface

    if name.count("/") == 2 and _find(get_interface, name) is not None:
        return ""
    return f"There is no type '{name}'\n{suggest_type(name, folder)}".rstrip()


def suggest_type(name: str, folder: str) -> str:
    """`Did you mean 'std_msgs/msg/String'?`, or nothing if no type is like that."""
    known = [
        f"{package}/{interface}"
        for package in registry.packages()
        for interface in registry.interface_names(package)
        if interface.startswith(f"{folder}/")
    ]
    package, _, last = name.replace(".", "/").rpartition("/")
    same_name = [each for each in known if each.rpartition("/")[2].lower() == last.lower() and each != name]
    if same_name and not registry.knows(package.partition("/")[0]):
        return f"Did you mean '{sorted(same_name, key=lambda each: not each.startswith('std_'))[0]}'?"
    full = f"{package}/{folder}/{last}" if package and "/" not in package else name
    return did_you_mean(full, [each for each in known if each != name])
