"""Where a widget publishes: a publisher that is made when it is first used, and the nodes that listen there."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from ..typed_names import enumerated
from ..words import listed
from .station import Station

PATIENCE = 1.0
"""Robot time, s, for which a message waits until a publisher that was just made has found its listeners."""


class Outlet:
    """One topic of one message class. Until the first message nothing of it is to be seen in the graph."""

    def __init__(self, station: Station, topic: str, message_class: Any, type_name: str) -> None:
        self._station = station
        self.topic, self.message_class, self.type_name = topic, message_class, type_name
        self._publisher: Any = None
        self._waiting: list[tuple[float, Any]] = []

    def publish(self, message: Any) -> None:
        """Publish; on a real network the very first messages wait until the listeners were found."""
        if self._publisher is None:
            self._publisher = self._station.node.create_publisher(self.message_class, self.topic, self._quality())
        self._waiting.append((self._station.now, message))
        self.flush()

    def flush(self) -> None:
        """Publish what waits, if the listeners are found by now."""
        while self._waiting and self._is_ready(self._waiting[0][0]):
            self._publisher.publish(self._waiting.pop(0)[1])

    def close(self) -> None:
        """Leave the topic."""
        self._waiting.clear()
        if self._publisher is not None:
            self._station.node.destroy_publisher(self._publisher)
            self._publisher = None

    def listeners(self) -> int:
        """How many subscriptions of this type others have there."""
        return sum(end.topic_type == self.type_name for end in self._others(self.topic))

    def why_unheard(self) -> str:
        """A sentence that says why no node gets what is published; "" if one does."""
        there = self._others(self.topic)
        if any(end.topic_type == self.type_name for end in there):
            return ""
        if there:
            types = listed(sorted({end.topic_type for end in there}))
            return f"The nodes that listen on {self.topic} expect {types}, not {self.type_name}."
        elsewhere = [
            name
            for name, types in self._station.node.get_topic_names_and_types()
            if self.type_name in types and any(end.topic_type == self.type_name for end in self._others(name))
        ]
        hint = f" There are listeners on {enumerated(elsewhere)}." if elsewhere else ""
        return f"No node listens on {self.topic}.{hint}"

    def _others(self, topic: str) -> list[Any]:
        me = (self._station.node.get_name(), self._station.node.get_namespace())
        ends = self._station.node.get_subscriptions_info_by_topic(topic)
        return [end for end in ends if (end.node_name, end.node_namespace) != me]

    def _is_ready(self, since: float) -> bool:
        if not self.listeners() or self._station.now - since >= PATIENCE:
            return True
        own = len(self._station.node.get_subscriptions_info_by_topic(self.topic)) - len(self._others(self.topic))
        return self._publisher.get_subscription_count() > own  # the recorder's, which is found at once

    def _quality(self) -> Any:
        """Reliable; and latched where a listener wants to be told of what was said before it came."""
        from rclpy.qos import DurabilityPolicy, QoSProfile

        wanted = {end.qos_profile.durability for end in self._others(self.topic)}
        latched = DurabilityPolicy.TRANSIENT_LOCAL in wanted
        return QoSProfile(
            depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
        )


def let_time_go_on(station: Station) -> None:
    """Start robot time if it stands still and can be turned: who acts wants to see what comes of it."""
    if station.clock is not None and not station.clock.playing:
        with suppress(RuntimeError):  # a plain script has no event loop; there time is run by hand
            station.clock.play(station.clock.rate)


def in_a_moment(station: Station, future: Any) -> None:
    """Where robot time stands still, let a moment of it pass (0.05 s at most), so that an answer can come."""
    for _ in range(10):
        if station.clock is None or station.clock.playing or future.done():
            return
        station.clock.step(0.005)
