"""What to try about an error of a learner's program: a call with the wrong arguments, or a value that was refused."""

from __future__ import annotations

import contextlib
import inspect
import re
import sys
from collections.abc import Callable
from typing import Any

from ..idl.names import did_you_mean
from ..sim import errors
from ..sim.errors import is_ours, traceback_entries
from . import names

# -- calls with wrong arguments ----------------------------------------------------------------------------------------

_WRONG_CALL = re.compile(r"([\w.]+)\(\) (missing|takes|got an unexpected keyword argument '(\w+)'|got multiple values)")
_PACKAGES = frozenset({"rclpy", "tf2_ros", "message_filters", "ament_index_python", "rosidl_runtime_py"})
"""The packages whose functions are explained."""


def call_advice(error: BaseException) -> str:
    """A sentence about a call with wrong arguments."""
    if not isinstance(error, TypeError):
        return ""
    text = str(error)
    if "'__init__' requires a 'super' object" in text:
        return "Call super with brackets: super().__init__('the_name_of_the_node')"
    match = _WRONG_CALL.match(text)
    # The call stands in a learner's code; there may be a wrapper of ours around the function.
    callers = [frame.tb_frame.f_code.co_filename for frame in traceback_entries(error.__traceback__)[-2:]]
    if match is None or all(map(is_ours, callers)):
        return ""
    name, keyword = match[1], match[3]
    owner, _, method = name.rpartition(".")
    if owner and "takes 0 positional arguments but 1 was given" in text:
        return f"A method's first parameter is self: def {method}(self)"
    if name == "Node.__init__":
        return "A node needs a name: super().__init__('the_name_of_the_node')"
    if owner == "RcutilsLogger":
        return "A log message is one text: put values into it with an f-string, as in f'x is {x}'."
    if (function := _function(name)) is not None:
        close = did_you_mean(keyword, inspect.signature(function).parameters) if keyword else ""
        return f"{close} It is called as {owner if method == '__init__' else method}({_signature(function)})".lstrip()
    kind = names.message_class(owner) if method == "__init__" else None
    if kind is None:
        return ""
    fields = list(kind.get_fields_and_field_types())
    return f"Give the fields by name: {kind.__name__}({', '.join(f'{each}=…' for each in fields[:3])})"


def _signature(function: Callable[..., Any]) -> str:
    """The parameters, those without a default and the first of the others."""
    parts = []
    for each in inspect.signature(function).parameters.values():
        if each.default is each.empty:
            parts += [each.name] if each.name != "self" and each.kind is not each.VAR_KEYWORD else []
        else:
            simple = each.default is None or isinstance(each.default, (bool, int, float, str))
            parts.append(f"{each.name}={each.default!r}" if simple else f"{each.name}=…")
    return ", ".join([*parts[:4], "…"] if len(parts) > 5 else parts)


def _function(name: str) -> Callable[..., Any] | None:
    """The function or method of rclpy of this name."""
    first, *rest = name.split(".")
    for module in [each for key, each in list(sys.modules.items()) if key.partition(".")[0] in _PACKAGES]:
        found = vars(module).get(first)
        for part in rest:
            found = getattr(found, part, None)
        if inspect.isfunction(found):
            return found
    return None


# -- errors of rclpy and of messages whose own words are those of the real one ----------------------------------------


def value_advice(error: BaseException) -> str:
    """A sentence about an error whose words are known."""
    kind, text = type(error).__name__, str(error)
    for known, pattern, sentence in _KNOWN:
        if kind == known and (match := re.search(pattern, text)):
            return sentence.format(*match.groups())
    return ""


_TYPES = {
    "srv": "a service's type: use create_service or create_client",
    "action": "an action's type: use rclpy.action.ActionServer or ActionClient",
    "msg": "a message's type: use create_publisher or create_subscription",
}

_KNOWN: list[tuple[str, str, str]] = [
    ("NotInitializedException", "", "Call rclpy.init() first, before any node is made."),
    ("InvalidQoSProfileException", "", "Say how many messages to keep: QoSProfile(depth=10, …)."),
    ("ParameterAlreadyDeclaredException", "",
     "A node declares each parameter only once; to change its value, use set_parameters([Parameter('name', value=…)])."),
    ("ParameterUninitializedException", "",
     "It was declared with only a type: give it a value when the program is started (-p name:=value), or a default in "
     "declare_parameter."),
    ("RuntimeError", r"Context.init\(\) must only be called once",
     "Call rclpy.init() once in a program; after rclpy.shutdown() it may be called again."),
    ("RuntimeError", r"Context must be initialized before it can be shutdown",
     "It was shut down already, or never initialised: rclpy.try_shutdown() works in either case."),
    *(("RuntimeError", rf"type provided is not valid \(<class '\w+\.{folder}\.\w+\.(\w+)'>", f"{{0}} is {about}.")
      for folder, about in _TYPES.items()),
    ("TypeError", r"Expected QoSProfile or int, but received <class '(?:str|float|NoneType)'>",
     "Give a whole number, the depth of the queue, as in 10, or a profile, as in QoSProfile(depth=10)."),
    ("AssertionError", r"The '(\w+)' field must be a sub message of type 'Time'",
     "A message has its own type for times: {0} = self.get_clock().now().to_msg()"),
    ("NotImplementedError", r"Service classes can not be instantiated",
     "A service has two halves, which are messages: make a request with NameOfTheService.Request()."),
    ("NotImplementedError", r"Action classes can not be instantiated",
     "An action's parts are messages: make a goal with NameOfTheAction.Goal()."),
    ("TypeError", r"unsupported operand type\(s\) for [-+]=?: .*'(Time|Duration)'",
     "A {0} is not a number: take .nanoseconds / 1e9 of it for seconds, or add a Duration(seconds=…)."),
    ("TypeError", r"The given value is not (?:one|a list of one) of the allowed types",
     "A parameter is a bool, int, float, str, or a list of values of one of these kinds."),
    ("TypeError", r"'Parameter' object is not iterable",
     "set_parameters takes a list: set_parameters([Parameter('name', value=…)])"),
    ("AttributeError", r"'NoneType' object has no attribute '_callbacks'",
     "A future is expected, such as call_async(request) returns, but None came."),
    ("TypeError", r"isinstance\(\) arg 2 must be a type", "Give the class itself, as in String, not String()."),
]  # fmt: skip
"""The name of an error, a pattern of its words, and what to say; {0} is what the pattern's group has found."""


# -- all advisers ------------------------------------------------------------------------------------------------------
# Nothing of this runs before an error is shown. Each adviser looks at an error and says a sentence, or nothing; the
# first that has something to say is heard. An error that brings advice of its own (a note) is left as it is.

ADVISERS: tuple[Callable[[BaseException], str], ...] = (
    names.import_advice,
    names.attribute_advice,
    call_advice,
    value_advice,
    names.device_advice,
)


def advise(error: BaseException) -> None:
    """Add a note to an error that has none, if there is something to say. What goes wrong in it is not worth a word."""
    if getattr(error, "__notes__", None) and not isinstance(error, AssertionError):  # those only tell what came
        return
    with contextlib.suppress(Exception):
        sentence = next(filter(None, (adviser(error) for adviser in ADVISERS)), "")
        if sentence and sentence not in getattr(error, "__notes__", ()):
            error.add_note(sentence)


def install() -> None:
    """Have each error that is shown be looked at; a second call changes nothing."""
    errors.before_showing = advise
