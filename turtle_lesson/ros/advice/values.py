"""Errors of rclpy and of messages whose own words are those of the real one, and what to try."""

from __future__ import annotations

import re
from collections.abc import Callable

Say = Callable[[re.Match[str]], str]


def advice(error: BaseException) -> str:
    """A sentence about an error whose words are known."""
    name, text = type(error).__name__, str(error)
    if name in _BY_KIND:
        return _BY_KIND[name]
    if name in _NAMES:
        return _name(text, _NAMES[name])
    for kind, pattern, say in _BY_TEXT:
        if name == kind and (match := re.search(pattern, text)):
            return say(match)
    return ""


def _name(text: str, what: str) -> str:
    """A name like the wrong one, which would do."""
    found = re.search(r"^  '(.*)'$", text, re.MULTILINE)
    wrong = found[1] if found else ""
    slash = "/" if what != "node" else ""
    good = (
        re.sub(rf"[^A-Za-z0-9_{slash}~{{}}]+", "_", wrong).rstrip("/")
        if slash
        else re.sub(r"\W+", "_", wrong).strip("_")
    )
    good = re.sub(r"(^|/)(\d)", r"\1_\2", good) if slash else re.sub(r"^(\d)", r"n\1", good)
    good = re.sub(r"_*/_*(?=\D)|_{2,}", lambda match: "/" if "/" in match[0] else "_", good)
    rule = f"In the name of a {what}, letters, digits and '_' are allowed, but no digit at the beginning"
    return f"{rule}: try '{good}'." if good and good != wrong else f"{rule}."


_NAMES = {
    "InvalidNodeNameException": "node", "InvalidTopicNameException": "topic",
    "InvalidServiceNameException": "service", "InvalidNamespaceException": "namespace",
}  # fmt: skip

_KINDS = {
    "srv": "a service's type: use create_service or create_client",
    "action": "an action's type: use rclpy.action.ActionServer or ActionClient",
    "msg": "a message's type: use create_publisher or create_subscription",
}

_BY_KIND = {
    "NotInitializedException": "Call rclpy.init() first, before any node is made.",
    "InvalidQoSProfileException": "Say how many messages to keep: QoSProfile(depth=10, …).",
    "ParameterAlreadyDeclaredException": (
        "A node declares each parameter only once; to change its value, use set_parameters([Parameter('name', value=…)])."
    ),
    "ParameterUninitializedException": (
        "It was declared with only a type: give it a value when the program is started (-p name:=value), "
        "or a default in declare_parameter."
    ),
}

_BY_TEXT: list[tuple[str, str, Say]] = [
    ("RuntimeError", r"Context.init\(\) must only be called once",
     lambda _: "Call rclpy.init() once in a program; after rclpy.shutdown() it may be called again."),
    ("RuntimeError", r"Context must be initialized before it can be shutdown",
     lambda _: "It was shut down already, or never initialised: rclpy.try_shutdown() works in either case."),
    ("RuntimeError", r"message type provided is not valid \(<class '(\w+)\.(srv|action)\.\w+\.(\w+)'>",
     lambda match: f"{match[3]} is {_KINDS[match[2]]}."),
    ("RuntimeError", r"(?:service|action) type provided is not valid \(<class '(\w+)\.(msg|srv|action)\.\w+\.(\w+)'>",
     lambda match: f"{match[3]} is {_KINDS[match[2]]}."),
    ("TypeError", r"Expected QoSProfile or int, but received <class '(?:str|float|NoneType)'>",
     lambda _: "Give a whole number, the depth of the queue, as in 10, or a profile, as in QoSProfile(depth=10)."),
    ("AssertionError", r"The '(\w+)' field must be a sub message of type 'Time'",
     lambda match: f"A message has its own type for times: {match[1]} = self.get_clock().now().to_msg()"),
    ("NotImplementedError", r"Service classes can not be instantiated",
     lambda _: "A service has two halves, which are messages: make a request with NameOfTheService.Request()."),
    ("NotImplementedError", r"Action classes can not be instantiated",
     lambda _: "An action's parts are messages: make a goal with NameOfTheAction.Goal()."),
    ("TypeError", r"unsupported operand type\(s\) for [-+]=?: '(Time|Duration)' and '(?:float|int)'",
     lambda match: f"A {match[1]} is not a number: take .nanoseconds / 1e9 of it for seconds, or add a Duration(seconds=…)."),
    ("TypeError", r"unsupported operand type\(s\) for [-+]=?: '(?:float|int)' and '(Time|Duration)'",
     lambda match: f"A {match[1]} is not a number: take .nanoseconds / 1e9 of it for seconds."),
    ("TypeError", r"The given value is not (?:one|a list of one) of the allowed types",
     lambda _: "A parameter is a bool, int, float, str, or a list of values of one of these kinds."),
    ("TypeError", r"'Parameter' object is not iterable",
     lambda _: "set_parameters takes a list: set_parameters([Parameter('name', value=…)])"),
    ("AttributeError", r"'NoneType' object has no attribute '_callbacks'",
     lambda _: "A future is expected, such as call_async(request) returns, but None came."),
    ("TypeError", r"isinstance\(\) arg 2 must be a type", lambda _: "Give the class itself, as in String, not String()."),
]  # fmt: skip
