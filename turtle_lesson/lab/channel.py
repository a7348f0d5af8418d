"""A channel: one topic that the recorder wants to hear, subscribed to while there is somebody to hear."""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Callable
from typing import Any

from .table import Listener
from .words import listed

DEPTH = 1000
"""Messages that wait if the recorder's node is not spun for a while: 16 seconds of a turtle's pose."""


class Channel:
    """Follows one topic of one type.

    `make_listener` is given the message class and returns the two-argument callback. With `driven`, it
    subscribes while somebody else subscribes (a topic that drives a machine); otherwise while somebody
    publishes. `latched` asks for the last message from before, too. `remedy` is what to try where no node publishes,
    `patience` where somebody does, who has said nothing yet.
    """

    def __init__(
        self,
        node: Any,
        topic: str,
        type_name: str,
        make_listener: Callable[[Any], Listener],
        remedy: str,
        *,
        driven: bool = False,
        latched: bool = False,
        patience: str = "Let time pass: lesson.run(1.0)",
    ) -> None:
        self.node = node
        self.topic = topic
        self.type_name = type_name
        self.remedy = remedy
        self.patience = patience
        self.driven = driven
        self.latched = latched
        self._make_listener = make_listener
        self._message_type: Any = None
        self._subscription: Any = None
        self._count = -1

    def __repr__(self) -> str:
        state = "listening" if self._subscription else "waiting"
        return f"<Channel {self.topic} [{self.type_name}], {state}>"

    def glance(self) -> None:
        """Follow, if the number of ends has changed since the last time: a cheap look, made often."""
        count = self.node.count_subscribers if self.driven else self.node.count_publishers
        if (number := count(self.topic)) != self._count:
            self._count = number
            self.follow()

    def follow(self) -> None:
        """Subscribe if there is a publisher, unsubscribe if there is none any more."""
        message_type = self._find_message_type() if self._wanted() else None
        if message_type is not self._message_type:
            self.close()
            if message_type is not None:
                self._open(message_type)

    def close(self) -> None:
        """Unsubscribe."""
        if self._subscription is not None:
            self.node.destroy_subscription(self._subscription)
        self._subscription = self._message_type = None

    def why_silent(self) -> str:
        """Why nothing was heard, and what to try."""
        publishers = self.node.get_publishers_info_by_topic(self.topic)
        if not publishers:
            return f"No node publishes {self.topic}. {self.remedy}"
        types = sorted({publisher.topic_type for publisher in publishers})
        if self.type_name not in types:
            mismatch = f"{self.topic} is published as {listed(types)}, but this plot reads {self.type_name}"
            return f"{mismatch}: compare the types in ros2 topic info {self.topic} --verbose"
        if self._find_message_type() is None:
            package = self.type_name.split("/")[0]
            unknown = f"{self.topic} is published as {self.type_name}, but that type cannot be imported here"
            return f"{unknown}: try colcon build --packages-select {package}, then source install/setup.bash"
        names = listed(sorted({_full_name(publisher) for publisher in publishers}))
        return f"{names} can publish {self.topic}, but no message has come yet. {self.patience}"

    def _wanted(self) -> bool:
        """Whether somebody else is there at the other end (or, of a driven topic, at this end)."""
        if not self.driven:
            ends = self.node.get_publishers_info_by_topic(self.topic)
            return any(end.topic_type == self.type_name for end in ends)
        me = (self.node.get_name(), self.node.get_namespace())
        others = [
            end
            for end in self.node.get_subscriptions_info_by_topic(self.topic)
            if (end.node_name, end.node_namespace) != me
        ]
        return any(end.topic_type == self.type_name for end in others)

    def _find_message_type(self) -> Any:
        """The message class, or None if it cannot be imported (a package that is not built and sourced)."""
        package, _, name = self.type_name.split("/")
        try:
            return getattr(importlib.import_module(f"{package}.msg"), name, None)
        except ImportError:
            return None

    def _open(self, message_type: Any) -> None:
        self._message_type = message_type
        listener = with_time(self.node, self._make_listener(message_type))
        quality = self._quality()
        self._subscription = self.node.create_subscription(message_type, self.topic, listener, quality)

    def _quality(self) -> Any:
        """Best effort matches every publisher; only a latched topic has to be reliable to give its past."""
        from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

        if self.latched:
            return QoSProfile(depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        return QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)


def with_time(node: Any, listener: Listener) -> Callable[..., None]:
    """Return a callback for any rclpy. Since Iron it tells a message's time; Humble's own does not yet.

    There the node's clock is read, which costs more, and tells when a message was handled, not when it was sent. The
    lab's node on a robot sees to that itself (see robot_node.py).
    """
    if getattr(node, "hears_times", False):
        return listener
    from rclpy.subscription import Subscription

    compiled = importlib.util.find_spec("rclpy._rclpy_pybind11") is not None
    if hasattr(Subscription, "CallbackType") or not compiled:
        return listener
    clock = node.get_clock()
    return lambda message: listener(message, {"source_timestamp": clock.now().nanoseconds})


def _full_name(end: Any) -> str:
    return f"{end.node_namespace.rstrip('/')}/{end.node_name}"
