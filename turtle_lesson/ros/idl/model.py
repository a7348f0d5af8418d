"""Interface definitions as data, what ROS derives from actions, and the error of a wrong definition.

Made by `definition.parse`; all but the error is immutable.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import PurePath

Plain = bool | int | float | str
Value = Plain | tuple[Plain, ...]


@dataclass(frozen=True, slots=True)
class FieldType:
    """The type of a field: `float32`, `string<=5[]`, `geometry_msgs/Point[3]`, ...

    Attributes:
        base: primitive type, or the message's name without its package.
        package: package of that message; None for a primitive type.
        size: the number of elements where it is fixed, or else the largest one; None where there is none.
        string_bound: largest number of characters, for a bounded string.
        folder: `msg`, except where an action's own messages hold its goal, result or feedback.
    """

    base: str
    package: str | None = None
    is_array: bool = False
    is_fixed: bool = False
    size: int | None = None
    string_bound: int | None = None
    folder: str = "msg"

    @property
    def is_primitive(self) -> bool:
        """Whether the elements are no messages."""
        return self.package is None

    @property
    def lengths(self) -> range:
        """How many elements an array may have."""
        if self.size is None:
            return range(sys.maxsize)
        return range(self.size if self.is_fixed else 0, self.size + 1)

    def __str__(self) -> str:
        base = self.base if self.package is None else f"{self.package}/{self.base}"
        bound = "" if self.string_bound is None else f"<={self.string_bound}"
        size = "" if self.size is None else self.size if self.is_fixed else f"<={self.size}"
        count = f"[{size}]" if self.is_array else ""
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


@dataclass(frozen=True, slots=True)
class Definition:
    """A message, with its fields and constants in the order of the file, or a service or action, with its parts.

    Attributes:
        folder: `msg`, `srv` or `action`.
        parts: the messages of a service (`X_Request`, `X_Response`) or action (`X_Goal`, `X_Result`, `X_Feedback`).
    """

    package: str
    folder: str
    name: str
    text: str
    file: str | None = None
    fields: tuple[Field, ...] = ()
    constants: tuple[Constant, ...] = ()
    parts: tuple[Definition, ...] = ()

    @property
    def full_name(self) -> str:
        """Name as ROS writes it, e.g. `geometry_msgs/msg/Twist`; services behind an action are `…/action/X_SendGoal`."""
        return f"{self.package}/{self.folder}/{self.name}"


def carriers(action: Definition) -> tuple[Definition, ...]:
    """In what ROS carries an action: the services SendGoal and GetResult, and the feedback message.

    Which fields they have follows `rosidl_parser.definition.Action`.
    """
    goal, result, feedback = (
        Field(FieldType(each.name, action.package, folder="action"), each.name.rpartition("_")[2].lower())
        for each in action.parts
    )
    goal_id = Field(FieldType("UUID", "unique_identifier_msgs"), "goal_id")
    stamp = Field(FieldType("Time", "builtin_interfaces"), "stamp")
    messages = {
        "SendGoal_Request": (goal_id, goal),
        "SendGoal_Response": (Field(FieldType("bool"), "accepted"), stamp),
        "GetResult_Request": (goal_id,),
        "GetResult_Response": (Field(FieldType("int8"), "status"), result),
        "FeedbackMessage": (goal_id, feedback),
    }

    def definition(name: str, fields: tuple[Field, ...] = (), parts: tuple[Definition, ...] = ()) -> Definition:
        text = "".join(f"{field}\n" for field in fields)
        return Definition(action.package, "action", f"{action.name}_{name}", text, action.file, fields, parts=parts)

    sent, accepted, asked, answered, told = (definition(name, fields) for name, fields in messages.items())
    return definition("SendGoal", parts=(sent, accepted)), definition("GetResult", parts=(asked, answered)), told


class InvalidDefinition(ValueError):
    """An interface definition that ROS 2 refuses, for a reason in the words of `rosidl_adapter.parser`.

    They are kept, since they are what a learner meets in a real build.

    Attributes:
        ros_error: name of the exception that ROS raises (`InvalidResourceName`, `NameError`, ...).
        hint: what to try.
        printed: the line that ROS writes to standard error before it raises, or None.
        interface: full name such as `robot_controller/msg/TurtleStatus`.
        file, line, line_text: where it is, counted from 1, without the line's comment; None where nothing single is to blame.
    """

    def __init__(
        self, reason: str, ros_error: str = "ValueError", *, hint: str = "", printed: str | None = None
    ) -> None:
        super().__init__(reason)
        self.reason = reason
        self.ros_error = ros_error
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
