"""Messages by their type's name: the class, setting fields, reading fields; what is not there cannot be looked at."""

from __future__ import annotations

import importlib
from typing import Any

from .rows import CannotLook


def interface(type_name: str) -> Any:
    """The class of a type such as "std_msgs/msg/String". Raises CannotLook where it cannot be imported."""
    package, kind, name = type_name.split("/")
    try:
        return getattr(importlib.import_module(f"{package}.{kind}"), name)
    except Exception as error:  # a package that was built badly can raise anything
        reason = " ".join(str(error).split())[:160]
        raise CannotLook(f"the type {type_name} cannot be imported here ({reason})") from None


def filled(message: Any, fields: dict[str, Any], type_name: str) -> Any:
    """The message with its fields set. Raises CannotLook for a field that it does not have."""
    for path, value in fields.items():
        *way, last = path.split("__")
        target = message
        try:
            for part in way:
                target = getattr(target, part)
            setattr(target, last, value)
        except (AttributeError, AssertionError, TypeError) as error:
            reason = " ".join(str(error).split())[:120]
            raise CannotLook(f"{type_name} cannot hold {path.replace('__', '.')} = {value!r} ({reason})") from None
    return message


def field(message: Any, path: str) -> Any:
    """What a message has in a field such as "linear.x". Raises CannotLook where there is none."""
    value = message
    for part in path.split("."):
        try:
            value = getattr(value, part)
        except AttributeError:
            raise CannotLook(f"{type(message).__name__} has no field {path}") from None
    return value
