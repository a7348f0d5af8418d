"""Interface definitions as data: messages, services and actions, what ROS derives from actions, and what can be wrong.

Made by the functions of `definition`; all but the errors is immutable.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePath
from typing import Literal

Plain = bool | int | float | str
Value = Plain | tuple[Plain, ...]
ArrayKind = Literal["none", "fixed", "unbounded", "bounded"]


@dataclass(frozen=True, slots=True)
class FieldType:
    """The type of a field: `float32`, `string<=5[]`, `geometry_msgs/Point[3]`, ...

    Attributes:
        base: primitive type, or the message's name without its package.
        package: package of that message; None for a primitive type.
        size: the number of elements of a `fixed` array, the largest one of a `bounded` one.
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
        count = {"none": "", "fixed": f"[{self.size}]", "bounded": f"[<={self.size}]", "unbounded": "[]"}[self.array]
        return base + bound + count


@dataclass(frozen=True, slots=True)
class Field:
    """One field: type, name, default value (None where the file gives none) and line in the file."""

    type: FieldType
    name: str
    default: Value | None = None
    line: int = 0

    def __str__(self) -> str:
        default = list(self.default) if isinstance(self.default, tuple) else self.default
        default = f"'{default}'" if isinstance(default, str) else default
        return f"{self.type} {self.name}" if default is None else f"{self.type} {self.name} {default}"


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


class _Named:
    __slots__ = ()
    package: str
    folder: str
    name: str

    @property
    def full_name(self) -> str:
        """Name as ROS writes it, e.g. `geometry_msgs/msg/Twist`; services behind an action are `…/action/X_SendGoal`."""
        return f"{self.package}/{self.folder}/{self.name}"


@dataclass(frozen=True, slots=True)
class MessageDefinition(_Named):
    """A message, or one part of a service or action: its fields and constants in the order of the file."""

    package: str
    name: str
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...]
    text: str
    folder: str = "msg"
    file: str | None = None

    def parts(self) -> tuple[MessageDefinition, ...]:
        """The messages in this definition: itself."""
        return (self,)


@dataclass(frozen=True, slots=True)
class ServiceDefinition(_Named):
    """A service: its request and its response, as messages `X_Request` and `X_Response`."""

    package: str
    name: str
    request: MessageDefinition
    response: MessageDefinition
    text: str
    file: str | None = None
    folder: str = "srv"

    def parts(self) -> tuple[MessageDefinition, ...]:
        """Request and response."""
        return self.request, self.response


@dataclass(frozen=True, slots=True)
class ActionDefinition(_Named):
    """An action: its goal, result and feedback, as messages `X_Goal`, `X_Result` and `X_Feedback`."""

    package: str
    name: str
    goal: MessageDefinition
    result: MessageDefinition
    feedback: MessageDefinition
    text: str
    file: str | None = None
    folder: str = "action"

    def parts(self) -> tuple[MessageDefinition, ...]:
        """Goal, result and feedback."""
        return self.goal, self.result, self.feedback


Definition = MessageDefinition | ServiceDefinition | ActionDefinition


def derived_parts(action: ActionDefinition) -> tuple[MessageDefinition, ...]:
    """The messages in which ROS carries an action: of the services SendGoal and GetResult, then the feedback message.

    Which fields they have follows `rosidl_parser.definition.Action`.
    """

    def part(suffix: str, *fields: Field) -> MessageDefinition:
        text = "".join(f"{field}\n" for field in fields)
        return MessageDefinition(action.package, f"{action.name}_{suffix}", fields, (), text, "action", action.file)

    goal, result, feedback = (
        Field(FieldType(each.name, action.package, folder="action"), each.name.rpartition("_")[2].lower())
        for each in action.parts()
    )
    goal_id = Field(FieldType("UUID", "unique_identifier_msgs"), "goal_id")
    stamp = Field(FieldType("Time", "builtin_interfaces"), "stamp")
    return (
        part("SendGoal_Request", goal_id, goal),
        part("SendGoal_Response", Field(FieldType("bool"), "accepted"), stamp),
        part("GetResult_Request", goal_id),
        part("GetResult_Response", Field(FieldType("int8"), "status"), result),
        part("FeedbackMessage", goal_id, feedback),
    )


# -- what can be wrong with a definition --------------------------------------------------------------------------
# ROS 2 refuses a wrong `.msg` or `.srv` file with a one-line reason (`rosidl_adapter.parser`). The reason is kept word for
# word, since it is what a learner meets in a real build; around it stand the file, the line, and what to try.


class InvalidDefinition(ValueError):
    """An interface definition that ROS 2 refuses, for a reason in its own words; `hint` says what to try.

    Attributes:
        ros_error: name of the exception that ROS raises (`InvalidResourceName`, `NameError`, ...).
        printed: the line that ROS writes to standard error before it raises, or None.
        interface: full name such as `robot_controller/msg/TurtleStatus`.
        file, line, line_text: where it is, counted from 1, without the line's comment; None where nothing single is to blame.
    """

    ros_error = "ValueError"

    def __init_subclass__(cls, ros_error: str = "") -> None:
        cls.ros_error = ros_error or cls.__name__

    def __init__(self, reason: str, *, hint: str = "", printed: str | None = None) -> None:
        super().__init__(reason)
        self.reason = reason
        self.hint = hint
        self.printed = printed
        self.interface: str | None = None
        self.file: str | None = None
        self.line: int | None = None
        self.line_text: str | None = None

    def locate(
        self, *, interface: str, file: str | None, line: int | None = None, line_text: str | None = None
    ) -> InvalidDefinition:
        """Note where the fault lies, unless that is known already; return the error itself."""
        if self.interface is None:
            self.interface, self.file = interface, file
            if self.line is None:
                self.line, self.line_text = line, line_text
        return self

    @property
    def qualified_ros_error(self) -> str:
        """The exception as a real traceback names it, e.g. `rosidl_adapter.parser.InvalidValue`."""
        own = self.ros_error.startswith(("Invalid", "Unknown"))
        return f"rosidl_adapter.parser.{self.ros_error}" if own else self.ros_error

    def __str__(self) -> str:
        text = self.reason
        if self.interface is not None:
            where = self.interface
            if self.file is not None:  # within its package: the same text wherever the package lies
                where = f"{where.rpartition('/')[0]}/{PurePath(self.file).name}"
            where += "" if self.line is None else f", line {self.line}, '{self.line_text}'"
            text = f"{where}: {text}"
        return f"{text}. {self.hint}" if self.hint else text


class InvalidResourceName(InvalidDefinition):
    """A package, message or type name that breaks the naming rules."""


class InvalidFieldDefinition(InvalidDefinition):
    """A line that holds a type and nothing else."""


class InvalidValue(InvalidDefinition):
    """A default value or constant that does not suit its type."""


class InvalidServiceSpecification(InvalidDefinition):
    """A `.srv` file without exactly one line `---`."""


class InvalidActionSpecification(InvalidDefinition):
    """An `.action` file without exactly two lines `---`."""


class UnknownMessageType(InvalidDefinition):
    """A field whose type is no known message."""


class InvalidMemberName(InvalidDefinition, ros_error="NameError"):
    """A field or constant name that breaks the naming rules."""


class InvalidType(InvalidDefinition, ros_error="TypeError"):
    """A type that cannot be."""


class DuplicateName(InvalidDefinition, ros_error="ValueError"):
    """Two fields or two constants of one name."""


class IndentedLine(InvalidDefinition, ros_error="IndexError"):
    """A field that does not start at the beginning of its line."""


class UnsupportedDefault(InvalidDefinition, ros_error="NotImplementedError"):
    """A default value for a field that is itself a message."""
