"""rclpy's exceptions, under their own names and with their own texts."""

from __future__ import annotations

from typing import Any, NoReturn

from turtle_lesson.ros.rmw import names
from turtle_lesson.ros.sim.errors import WorldClosed
from turtle_lesson.ros.sim.simulation import Simulation

from ._rclpy_pybind11 import InvalidHandle, RCLError
from ._rclpy_pybind11 import NodeNameNonExistentError as NodeNameNonExistentError
from ._rclpy_pybind11 import RCLInvalidROSArgsError as RCLInvalidROSArgsError
from ._rclpy_pybind11 import TimerCancelledError as TimerCancelledError
from ._rclpy_pybind11 import UnknownROSArgsError as UnknownROSArgsError


class NotInitializedException(Exception):
    """ROS is used before `rclpy.init()`, or after the shutdown."""

    def __init__(self, *args: object) -> None:
        super().__init__("rclpy.init() has not been called", *args)


class NoTypeSupportImportedException(Exception):
    """A type is no ROS 2 interface."""

    def __init__(self, *args: object) -> None:
        super().__init__("no type_support imported")


class NameValidationException(Exception):
    """A name breaks the rules; the text has a caret under the bad character."""

    def __init__(self, name_type: str, name: str, error_msg: str, invalid_index: int, *args: object) -> None:
        super().__init__(names.flaw_text(name_type, name, names.Flaw(error_msg, invalid_index)), *args)


class _InvalidName(NameValidationException):
    """Base class: of which kind of name it is, is said by the class."""

    _kind = ""

    def __init__(self, name: str, error_msg: str, invalid_index: int, *args: object) -> None:
        super().__init__(self._kind, name, error_msg, invalid_index)


class InvalidNamespaceException(_InvalidName):
    """A namespace breaks the rules."""

    _kind = "namespace"


class InvalidNodeNameException(_InvalidName):
    """A node's name breaks the rules."""

    _kind = "node name"


class InvalidTopicNameException(_InvalidName):
    """A topic's name breaks the rules."""

    _kind = "topic name"


class InvalidServiceNameException(_InvalidName):
    """A service's name breaks the rules."""

    _kind = "service name"


class ParameterException(Exception):
    """Something is wrong with one or more parameters; `args` holds their names last."""

    def __init__(self, error_msg: str, parameters: Any, *args: object) -> None:
        super().__init__(error_msg, parameters, *args)


class ParameterNotDeclaredException(ParameterException):
    """A parameter is used that was never declared."""

    def __init__(self, parameters: Any, *args: object) -> None:
        super().__init__("Invalid access to undeclared parameter(s)", parameters, *args)


class ParameterAlreadyDeclaredException(ParameterException):
    """A parameter is declared twice."""

    def __init__(self, parameters: Any, *args: object) -> None:
        super().__init__("Parameter(s) already declared", parameters, *args)


class InvalidParameterException(ParameterException):
    """A parameter's name is not allowed."""

    def __init__(self, parameter_name: Any, *args: object) -> None:
        super().__init__("Invalid parameter name", parameter_name, *args)


class InvalidParameterValueException(ParameterException):
    """A parameter's value is refused."""

    def __init__(self, parameter: Any, value: Any, reason: str, *args: object) -> None:
        super().__init__(f"Invalid parameter value ({value}) for parameter. Reason: {reason}", parameter, *args)


class InvalidParameterTypeException(ParameterException):
    """A parameter that was declared with a type is given a value of another one."""

    def __init__(self, desired_parameter: Any, expected_type: str) -> None:
        Exception.__init__(
            self,
            f"Trying to set parameter '{desired_parameter.name}' to '{desired_parameter._value}' of type "
            f"'{desired_parameter.type_.name}', expecting type '{expected_type}'",
        )
        if (desired_parameter.type_.name, expected_type) == ("INTEGER", "DOUBLE"):
            self.add_note(
                f"ROS does not convert whole numbers to floating-point numbers by itself: write {desired_parameter._value}.0"
            )


class ParameterImmutableException(ParameterException):
    """A read-only parameter is to be changed."""

    def __init__(self, parameter_name: Any, *args: object) -> None:
        super().__init__("Attempted to modify read-only parameter", parameter_name, *args)


class ParameterUninitializedException(ParameterException):
    """A parameter that was declared with a type but without a value is read."""

    def __init__(self, parameter_name: str, *args: object) -> None:
        Exception.__init__(self, f"The parameter '{parameter_name}' is not initialized")


def refuse_destroyed(simulation: Simulation) -> NoReturn:
    """Raise InvalidHandle for the use of something destroyed, or WorldClosed if its world was closed."""
    if simulation.closed:
        raise WorldClosed("this belongs to a world that a later start() has closed: make its node, and it, again")
    error = InvalidHandle("cannot use Destroyable because destruction was requested")
    cause = "It, or its node, was destroyed, perhaps by rclpy.shutdown()"
    error.add_note(f"{cause}: after rclpy.init(), make the node and this again; in a notebook, run their cells again.")
    raise error


def refuse_ended(doing: str) -> NoReturn:
    """Raise RCLError for `doing` something with the graph after rclpy.shutdown()."""
    error = RCLError(f"{doing} context is invalid")
    cause = "rclpy.shutdown(), or Ctrl-C, has ended ROS in this program"
    error.add_note(f"{cause}. Do this before that; or call rclpy.init() again, and make the node again.")
    raise error


class ROSInterruptException(Exception):
    """A wait was cut short by the shutdown."""

    def __init__(self) -> None:
        super().__init__("rclpy.shutdown() has been called")


def not_valid(what: str) -> RCLError:
    """The error for something that needs a context, where rclpy.init() has not been called, or shutdown has."""
    error = RCLError(
        f"failed to create {what}: the given context is not valid, either rcl_init() was not called or rcl_shutdown() "
        "was called."
    )
    error.add_note("Call rclpy.init() before this, and rclpy.shutdown() after it.")
    return error
