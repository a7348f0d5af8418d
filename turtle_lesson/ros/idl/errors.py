"""What can be wrong with an interface definition, and how we say it.

ROS 2 refuses a wrong `.msg` or `.srv` file with a one-line reason (`rosidl_adapter.parser`). The reason is
kept word for word in `InvalidDefinition.reason`, since it is what a learner meets in a real build; around it
we put the file, the line, and what to try.
"""

from __future__ import annotations

from pathlib import PurePath


class InvalidDefinition(ValueError):
    """An interface definition that ROS 2 refuses.

    Attributes:
        reason: ROS's own words.
        ros_error: name of the exception that ROS raises (`InvalidResourceName`, `NameError`, ...).
        printed: the line that ROS writes to standard error before it raises, or None.
        interface: full name such as `robot_controller/msg/TurtleStatus`.
        file: path of the file as text, or None where the text came from no file.
        line: line number in that file, counted from 1, or None where no single line is to blame.
        line_text: that line, without its comment.
        hint: what to try, or an empty string.
    """

    ros_error = "ValueError"

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
        where = self._where()
        text = f"{where}: {self.reason}" if where else self.reason
        return f"{text}. {self.hint}" if self.hint else text

    def _where(self) -> str:
        """File within its package, and line: the same text wherever the package lies."""
        if self.interface is None:
            return ""
        where = self.interface
        if self.file is not None:
            package, folder, _ = self.interface.split("/")
            where = f"{package}/{folder}/{PurePath(self.file).name}"
        return where if self.line is None else f"{where}, line {self.line}, '{self.line_text}'"

    def __reduce__(self) -> tuple[object, ...]:
        return _rebuild, (type(self), self.reason), self.__dict__


def _rebuild(kind: type[InvalidDefinition], reason: str) -> InvalidDefinition:
    return kind(reason)


class InvalidResourceName(InvalidDefinition):
    """A package, message or type name that breaks the naming rules."""

    ros_error = "InvalidResourceName"


class InvalidFieldDefinition(InvalidDefinition):
    """A line that holds a type and nothing else."""

    ros_error = "InvalidFieldDefinition"


class InvalidValue(InvalidDefinition):
    """A default value or constant that does not suit its type."""

    ros_error = "InvalidValue"


class InvalidServiceSpecification(InvalidDefinition):
    """A `.srv` file without exactly one line `---`."""

    ros_error = "InvalidServiceSpecification"


class InvalidActionSpecification(InvalidDefinition):
    """An `.action` file without exactly two lines `---`."""

    ros_error = "InvalidActionSpecification"


class UnknownMessageType(InvalidDefinition):
    """A field whose type is no known message."""

    ros_error = "UnknownMessageType"


class InvalidMemberName(InvalidDefinition):
    """A field or constant name that breaks the naming rules (ROS raises NameError)."""

    ros_error = "NameError"


class InvalidType(InvalidDefinition):
    """A type that cannot be (ROS raises TypeError)."""

    ros_error = "TypeError"


class DuplicateName(InvalidDefinition):
    """Two fields or two constants of one name (ROS raises ValueError)."""

    ros_error = "ValueError"


class IndentedLine(InvalidDefinition):
    """A field that does not start at the beginning of its line (ROS raises IndexError)."""

    ros_error = "IndexError"


class UnsupportedDefault(InvalidDefinition):
    """A default value for a field that is itself a message (ROS raises NotImplementedError)."""

    ros_error = "NotImplementedError"
