"""What all generated message classes share: how they show, compare and refuse."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from turtle_lesson.ros.interfaces.checks import are_on, refusal
from turtle_lesson.ros.interfaces.names import did_you_mean

plain_text = str.__str__  # a plain str, even of an instance of a subclass


@dataclass(frozen=True, slots=True)
class TypeSupport:
    """Stands where ROS keeps pointers to its C code: tells that a class is an interface, and of which kind.

    Attributes:
        kind: `msg`, `srv` or `action`.
        name: full name such as `geometry_msgs/msg/Twist`.
    """

    kind: str
    name: str


class Unset:
    """Default of a constructor argument that stands for a fresh value; shows as that value in a signature."""

    __slots__ = ("_text",)

    def __init__(self, text: str) -> None:
        self._text = text

    def __repr__(self) -> str:
        return self._text


def message_repr(message: Any) -> str:
    """`geometry_msgs.msg.Vector3(x=0.0, y=0.0, z=0.0)`."""
    kind = type(message)
    package = kind.__module__.rpartition(".")[0]
    name = f"{package}.{kind.__name__}" if package else kind.__name__
    fields = ", ".join(f"{slot[1:]}={_field_repr(getattr(message, slot))}" for slot in message.__slots__)
    return f"{name}({fields})"


def _field_repr(value: object) -> str:
    if isinstance(value, array):
        return repr(value)[len("array('f', ") : -1] if value else "[]"
    return repr(value)


def same_array(one: Any, other: Any) -> bool:
    """Whether two numpy arrays hold the same numbers."""
    return bool(one.shape == other.shape and (one == other).all())


def refuse_arguments(message_class: type, unknown: Iterable[str]) -> None:
    """Refuse constructor arguments that are no fields, where values are checked.

    `check_fields`, with which newer releases switch the checks on for one message, is taken, and has no other effect.
    """
    names = sorted(set(unknown) - {"check_fields"})
    if not names or not are_on():
        return
    fields = [slot[1:] for slot in message_class.__slots__]  # type: ignore[attr-defined]
    hints = [hint for hint in (did_you_mean(name, fields) for name in names) if hint]
    note = " ".join([*hints, f"The fields are: {', '.join(fields) or 'none'}"])
    raise refusal(f"Invalid arguments passed to constructor: {', '.join(names)}", note)


def copy_messages(check: Callable[[Any], Any]) -> Callable[[Any], list[Any]]:
    """Copier of a field that holds several messages; what was slipped in since the check is refused here."""

    def copy(value: Any) -> list[Any]:
        return [each._wire_copy() for each in check(value)]

    return copy


def copy_texts(check: Callable[[Any], Any]) -> Callable[[Any], list[str]]:
    """Copier of a field that holds several strings."""

    def copy(value: Any) -> list[str]:
        return [plain_text(each) for each in check(value)]

    return copy


def copy_values(check: Callable[[Any], Any]) -> Callable[[Any], list[Any]]:
    """Copier of a field that holds several booleans or bytes."""

    def copy(value: Any) -> list[Any]:
        return list(check(value))

    return copy
