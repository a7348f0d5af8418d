"""What all filters have in common, and the first one of a row: a subscription."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.node import Node


class SimpleFilter:
    """Hands what comes out of it to callbacks."""

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., Any], tuple[Any, ...]]] = {}

    def registerCallback(self, cb: Callable[..., Any], *args: Any) -> int:
        """Have `cb(message, …, *args)` called for each output; returns the callback's number."""
        if not callable(cb):
            error = TypeError(f"a callback is expected, got {cb!r}")
            error.add_note(
                "Hand over the function itself, as in self.both; with brackets it would be called immediately."
            )
            raise error
        number = len(self.callbacks)
        self.callbacks[number] = (cb, args)
        return number

    def signalMessage(self, *msg: Any) -> None:
        """Hand messages to all callbacks."""
        for callback, more in list(self.callbacks.values()):
            callback(*msg, *more)


class Subscriber(SimpleFilter):
    """A subscription as a filter: `Subscriber(node, type, topic, qos_profile=10, …)`, as `create_subscription` has it.

    The profile of quality is 10 unless it is given, and it is given by its name: `qos_profile=…`.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__()
        if len(args) != 3 or not isinstance(args[0], Node):
            raise _not_three(args)
        self.node, _, self.topic = args
        kwargs.setdefault("qos_profile", 10)
        self.sub = self.node.create_subscription(*args[1:], self.callback, **kwargs)

    def callback(self, msg: Any) -> None:
        """Called for each message that comes."""
        self.signalMessage(msg)

    def getTopic(self) -> str:
        """The topic's name, as it was given."""
        return self.topic

    def __getattr__(self, key: str) -> Any:
        """Everything else is the subscription's."""
        if key == "sub":  # it could not be made
            raise AttributeError(key)
        return getattr(self.sub, key)


def _not_three(args: tuple[Any, ...]) -> TypeError:
    error = TypeError(f"Subscriber() takes a node, a message type and a topic, then keywords; got {args!r}")
    if len(args) > 3:
        error.add_note(f"Give the profile of quality by its name: qos_profile={args[3]!r}.")
    elif args and not isinstance(args[0], Node):
        error.add_note("The node comes first: Subscriber(self, Image, '/camera').")
    return error
