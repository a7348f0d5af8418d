"""Sentences about mistakes that learners make, and about what this rclpy does not have. They run only after an error."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from collections.abc import Callable, Iterable
from typing import Any

from turtle_lesson.ros.idl.names import nearest


def shown(value: object) -> str:
    """A value as an error text shows it: without the addresses that Python prints for functions."""
    if isinstance(value, type):
        return f"the class {value.__name__}"
    return f"the function {value.__name__}" if callable(value) and hasattr(value, "__name__") else repr(value)


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """`; did you mean 'speed'?`, or nothing if no known name is like this one."""
    close = nearest(name, known, exact=True)
    return f"; did you mean {close!r}?" if close else ""


class SetByInit:
    """Stands on a class for an attribute that its __init__ sets. Looked up before that, it tells what was forgotten."""

    def __get__(self, owner: object, kind: type) -> Any:
        raise AttributeError(
            f"this {kind.__name__} is not a node yet: begin its __init__ with super().__init__('its_name')"
        )


def no_node(value: object) -> TypeError:
    """The error for something else where a node is expected."""
    if isinstance(value, type):
        hint = f"make an instance first: node = {value.__name__}()"
    elif hasattr(value, "create_publisher"):
        hint = "begin its __init__ with super().__init__('its_name')"
    else:
        hint = "after rclpy.init(), make one: node = rclpy.create_node('its_name')"
    return TypeError(f"a node is expected, got {shown(value)}; {hint}")


def no_message(value: object, kind: Any) -> TypeError:
    """The error for something else where a message of a type is to be published."""
    error, name = TypeError(f"Expected {kind}, got {type(value)}"), kind.__name__
    if value is kind:
        error.add_note(f"This is the class itself; {name}() makes a message.")
    elif type(value).__name__ == name and type(value).__module__ == kind.__module__:
        error.add_note(f"This {name} was made before {name} was built again: import it again, and make it again.")
    elif not hasattr(value, "get_fields_and_field_types"):
        fields = list(kind.get_fields_and_field_types())
        example = f"{name}({fields[0]}=…)" if fields else f"{name}()"
        error.add_note(f"Put it into a message first: {example}.")
    else:
        other = type(value).__name__
        error.add_note(f"Make a {name}, or a publisher for {other}: create_publisher({other}, …).")
    return error


def is_raised_by_the_call(error: Exception) -> bool:
    """Whether the call in the innermost `try` raised an error, and not the code that it called."""
    return error.__traceback__ is not None and error.__traceback__.tb_next is None


def explain_call(entity: Any, arguments: tuple[Any, ...] | None, error: TypeError) -> None:
    """Add to an error that calling a callback raised (not one from inside it) how the callback is called."""
    if not is_raised_by_the_call(error):
        return
    if entity.callback is None or not callable(entity.callback):
        error.add_note(
            f"The callback of {entity!r} is {entity.callback!r}. Hand over the function itself, as in self.tick; "
            "with brackets, as in self.tick(), it is called immediately, and its result is handed over."
        )
    elif arguments is not None:
        what = ", ".join(_PARTS.get(type(entity).__name__, ())[: len(arguments)])
        error.add_note(f"The callback of {entity!r} is called with ({what}).")


def explain_event_loop(error: Exception) -> None:
    """Add to asyncio's complaint that it does not run what to do instead."""
    if isinstance(error, RuntimeError) and str(error) == "no running event loop":
        error.add_note(
            "rclpy's executors are not asyncio loops: asyncio's functions do not work in their callbacks. To wait, await "
            "a future of rclpy's, or have a timer call you later."
        )


_PARTS = {"Subscription": ("message", "info"), "Service": ("request", "response")}


def explain_missing(module: str) -> Callable[[str], Any]:
    """A module-level `__getattr__`: imports a submodule that is used without having been imported, as in
    `rclpy.logging.get_logger`, which works on a real ROS 2, too; or says that there is nothing of that name.
    """

    def missing(name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        here = vars(sys.modules[module])
        is_package = "__path__" in here and not name.startswith("_")
        if is_package and importlib.util.find_spec(f"{module}.{name}") is not None:
            return importlib.import_module(f"{module}.{name}")
        known = [public for public in here if not public.startswith("_")]
        hint = did_you_mean(name, known) or "; a real ROS 2 may have it, but it is not available here yet"
        # With an object that has nothing, Python adds no "Did you mean" of its own.
        raise AttributeError(f"the simulated module {module!r} has no {name!r}{hint}", name=name, obj=None)

    return missing


_TAKEN = {
    "rclpy.node": {
        "rcl_interfaces.msg": "FloatingPointRange IntegerRange ListParametersResult ParameterDescriptor ParameterEvent"
        " ParameterType ParameterValue SetParametersResult",
        "rclpy.callback_groups": "MutuallyExclusiveCallbackGroup ReentrantCallbackGroup",
        "rclpy.exceptions": "InvalidHandle InvalidParameterException InvalidParameterTypeException"
        " InvalidParameterValueException InvalidTopicNameException NodeNameNonExistentError"
        " ParameterAlreadyDeclaredException ParameterImmutableException ParameterNotDeclaredException"
        " ParameterUninitializedException",
        "rclpy.timer": "Rate",
        "rclpy.type_support": "MsgT SrvT",
        "typing": "Any Callable Dict Iterator List Optional Sequence Tuple Type TypeVar Union",
    },
    "rclpy.parameter": {"rcl_interfaces.msg": "ParameterType ParameterValue"},
}
"""Names that two modules of rclpy only import for themselves, by where they are from. Programs take them from there all the
same, as in `from rclpy.node import ParameterDescriptor`. (Source of facts: the import lines of rclpy's modules.)"""


def find_taken(module: str) -> Callable[[str], Any]:
    """A module-level `__getattr__` for the names in _TAKEN, which imports them when a program asks, and not before."""

    def find(name: str) -> Any:
        for origin, names in _TAKEN[module].items():
            if name in names.split():
                return getattr(importlib.import_module(origin), name)
        raise AttributeError(f"module {module!r} has no attribute {name!r}")

    return find


def refuse_unbuilt(**arguments: Any) -> None:
    """Raise NotImplementedError if one of these arguments was given, which rclpy has and the simulation does not."""
    for name, value in arguments.items():
        if value:
            raise NotImplementedError(f"{name} is not available here, got {value!r}: leave it out")
