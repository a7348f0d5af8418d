"""Interface definitions as data: messages, services and actions, and what ROS derives from services and actions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

# -- model --------------------------------------------------------------------------------------------------------
# Interface definitions as data: messages, services and actions with their fields and constants.
# Made by the functions of `definition`; everything here is immutable.

Plain = bool | int | float | str
Value = Plain | tuple[Plain, ...]
ArrayKind = Literal["none", "fixed", "unbounded", "bounded"]


@dataclass(frozen=True, slots=True)
class FieldType:
    """The type of a field: `float32`, `string<=5[]`, `geometry_msgs/Point[3]`, ...

    Attributes:
        base: primitive type, or the message's name without its package.
        package: package of that message; None for a primitive type.
        array: `none`, `fixed` (exactly `size`), `bounded` (up to `size`) or `unbounded`.
        size: number of elements where the type says one.
        string_bound: largest number of characters, for a bounded string.
        folder: `msg`, except where an action's own messages hold its goal, result or feedback.
    """

    base: str
    package: str | None = None
    array: ArrayKind = "none"
    size: int | None = None
    string_bound: int | None = None
    folder: str = "msg"

    @property
    def is_primitive(self) -> bool:
        """Whether the elements are no messages."""
        return self.package is None

    @property
    def is_array(self) -> bool:
        """Whether the field holds several values."""
        return self.array != "none"

    @property
    def is_fixed(self) -> bool:
        """Whether the number of elements is exactly `size`."""
        return self.array == "fixed"

    @property
    def is_bounded(self) -> bool:
        """Whether the number of elements is at most `size`."""
        return self.array == "bounded"

    def __str__(self) -> str:
        base = self.base if self.package is None else f"{self.package}/{self.base}"
        bound = "" if self.string_bound is None else f"<={self.string_bound}"
        count = {
            "none": "",
            "fixed": f"[{self.size}]",
            "bounded": f"[<={self.size}]",
            "unbounded": "[]",
        }[self.array]
        return base + bound + count


@dataclass(frozen=True, slots=True)
class Field:
    """One field: type, name, default value (None where the file gives none) and line in the file."""

    type: FieldType
    name: str
    default: Value | None = None
    line: int = 0

    def __str__(self) -> str:
        text = f"{self.type} {self.name}"
        if self.default is None:
            return text
        if isinstance(self.default, tuple):
            return f"{text} {list(self.default)}"
        return f"{text} '{self.default}'" if isinstance(self.default, str) else f"{text} {self.default}"


@dataclass(frozen=True, slots=True)
class Constant:
    """One constant: primitive type, name, value and line in the file."""

    type: str
    name: str
    value: Plain
    line: int = 0

    def __str__(self) -> str:
        value = f"'{self.value}'" if isinstance(self.value, str) else self.value
        return f"{self.type} {self.name}={value}"


@dataclass(frozen=True, slots=True)
class MessageDefinition:
    """A message, or one part of a service or action: its fields and constants in the order of the file."""

    package: str
    name: str
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...]
    text: str
    folder: str = "msg"
    file: str | None = None

    @property
    def full_name(self) -> str:
        """Name as ROS writes it, e.g. `geometry_msgs/msg/Twist`."""
        return f"{self.package}/{self.folder}/{self.name}"

    def parts(self) -> tuple[MessageDefinition, ...]:
        """The messages in this definition: itself."""
        return (self,)


@dataclass(frozen=True, slots=True)
class ServiceDefinition:
    """A service: its request and its response, as messages `X_Request` and `X_Response`."""

    package: str
    name: str
    request: MessageDefinition
    response: MessageDefinition
    text: str
    file: str | None = None
    folder: str = "srv"

    @property
    def full_name(self) -> str:
        """Name as ROS writes it, e.g. `turtlesim/srv/Spawn`; those behind an action are `…/action/X_SendGoal`."""
        return f"{self.package}/{self.folder}/{self.name}"

    def parts(self) -> tuple[MessageDefinition, ...]:
        """Request and response."""
        return self.request, self.response


@dataclass(frozen=True, slots=True)
class ActionDefinition:
    """An action: its goal, result and feedback, as messages `X_Goal`, `X_Result` and `X_Feedback`."""

    package: str
    name: str
    goal: MessageDefinition
    result: MessageDefinition
    feedback: MessageDefinition
    text: str
    file: str | None = None
    folder: str = "action"

    @property
    def full_name(self) -> str:
        """Name as ROS writes it, e.g. `turtlesim/action/RotateAbsolute`."""
        return f"{self.package}/action/{self.name}"

    def parts(self) -> tuple[MessageDefinition, ...]:
        """Goal, result and feedback."""
        return self.goal, self.result, self.feedback


Definition = MessageDefinition | ServiceDefinition | ActionDefinition


# -- actions ------------------------------------------------------------------------------------------------------
# The services and messages that ROS derives from an action: how goal, result and feedback travel.
# Which fields they have follows `rosidl_parser.definition.Action`.

GOAL_ID = Field(FieldType("UUID", "unique_identifier_msgs"), "goal_id")
STAMP = Field(FieldType("Time", "builtin_interfaces"), "stamp")
ACCEPTED = Field(FieldType("bool"), "accepted")
STATUS = Field(FieldType("int8"), "status")


def derived_parts(action: ActionDefinition) -> tuple[MessageDefinition, ...]:
    """Requests and responses of the services SendGoal and GetResult, then the feedback message."""
    return (
        _part(action, "SendGoal_Request", GOAL_ID, _own(action, "goal")),
        _part(action, "SendGoal_Response", ACCEPTED, STAMP),
        _part(action, "GetResult_Request", GOAL_ID),
        _part(action, "GetResult_Response", STATUS, _own(action, "result")),
        _part(action, "FeedbackMessage", GOAL_ID, _own(action, "feedback")),
    )


def _own(action: ActionDefinition, part: str) -> Field:
    return Field(FieldType(f"{action.name}_{part.capitalize()}", action.package, folder="action"), part)


def _part(action: ActionDefinition, suffix: str, *fields: Field) -> MessageDefinition:
    text = "".join(f"{field}\n" for field in fields)
    name = f"{action.name}_{suffix}"
    return MessageDefinition(action.package, name, fields, (), text, "action", action.file)
