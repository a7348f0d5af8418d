"""Values of YAML put into the fields of a message: what `ros2 topic pub` does with what was typed.

The rules and sentences are those of rosidl_runtime_py/set_message.py, pinned by recordings of a real one.
"""

from __future__ import annotations

import array
from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from rosidl_parser.definition import AbstractNestedType, NamespacedType

from turtle_lesson.ros.idl.names import did_you_mean

from .convert import get_message_slot_types
from .import_message import import_message_from_namespaced_type

Setter = Callable[[Any], None]


def set_message_fields(
    msg: Any, values: dict[str, Any], expand_header_auto: bool = False, expand_time_now: bool = False
) -> list[Setter]:
    """Set the fields of a message, request or goal to values as YAML gives them, converted to the fields' types.

    Args:
        expand_header_auto: whether `auto` for a `std_msgs/Header` means one whose stamp is set later.
        expand_time_now: whether `now` for a `builtin_interfaces/Time` means one that is set later.

    Returns functions that want a `builtin_interfaces/Time` and set these stamps, to be called with the time of sending.
    Raises AttributeError where there is no field of a name; a note says which there are; TypeError, ValueError, OverflowError
    or AssertionError where a value does not suit its field.
    """
    filling = _Filling(expand_header_auto, expand_time_now)
    filling.fill(msg, deepcopy(values))
    return filling.setters


@dataclass
class _Filling:
    """One call: what is expanded, and the setters collected on the way."""

    header_auto: bool
    time_now: bool
    setters: list[Setter] = field(default_factory=list)

    def fill(self, message: Any, values: Any) -> None:
        if not hasattr(values, "items"):
            raise TypeError(f"Value '{values!s:.200}' is expected to be a dictionary but is a {type(values).__name__}")
        types = get_message_slot_types(message)
        for name, value in values.items():
            if not isinstance(name, str):
                wrong = TypeError(f"attribute name must be string, not '{type(name).__name__}'")
                wrong.add_note(f"YAML reads it as {str(name).lower()}: put the field's name in quotes, such as 'off'.")
                raise wrong
            if name not in types:
                error = AttributeError(f"'{type(message).__name__}' object has no attribute '{name:.200}'")
                hint = did_you_mean(name[:100], types) or f"The fields are: {', '.join(types) or 'none'}."
                if name.partition(":")[0] in types:
                    hint = f"YAML wants a space after the colon: {name.replace(':', ': ', 1)}"
                error.add_note(hint)
                raise error
            self._set(message, name, value, types[name])

    def _set(self, message: Any, name: str, value: Any, type_: Any) -> None:
        now = getattr(message, name)
        kind = f"{type(now).__module__}.{type(now).__name__}"  # by its name: it may have been generated anew since
        word = value if isinstance(value, str) else ""
        if self.header_auto and (word, kind) == ("auto", "std_msgs.msg._header.Header"):
            self.setters.append(partial(setattr, now, "stamp"))
        elif self.time_now and (word, kind) == ("now", "builtin_interfaces.msg._time.Time"):
            self.setters.append(partial(setattr, message, name))
        else:
            setattr(message, name, self._elements(type_, self._converted(now, value)))

    def _converted(self, now: Any, value: Any) -> Any:
        """What a field that holds `now` is set to, when YAML says `value`."""
        kind = type(now)
        if kind is array.array:
            return array.array(now.typecode, value)
        if kind.__module__ == "numpy":
            import numpy

            return numpy.array(value, dtype=now.dtype)
        if type(value) is kind:
            return value
        if kind is bytes and isinstance(value, int):
            return bytes(min(value, 2))  # as many zeros, as `bytes(5)` makes; the field takes one, so two are refused
        if hasattr(kind, "get_fields_and_field_types"):
            made = kind()
            self.fill(made, value)
            return made
        try:
            return kind(value)
        except TypeError:
            self.fill(kind(), value)  # the real one takes the field for a message, and says so
            raise

    def _elements(self, type_: Any, values: Any) -> Any:
        """The messages of a field that holds several, each made of a dictionary; any other value as it is."""
        if not (isinstance(type_, AbstractNestedType) and isinstance(type_.value_type, NamespacedType)):
            return values
        element_class = import_message_from_namespaced_type(type_.value_type)
        made = [element_class() for _ in values]
        for message, value in zip(made, values, strict=True):
            self.fill(message, value)
        return made
