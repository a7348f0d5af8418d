"""The node that offers a service, as seen from outside: whether it is still there, and what it warns of."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from .station import Station

WARNING = 30
"""rcl_interfaces/msg/Log: this level and those above it."""

SLACK = 0.1
"""Robot time, s, by which a warning may be older than its call, or newer than the answer to it."""


class Server:
    """The node that offers one service. `said()` is called with each of its warnings."""

    def __init__(self, station: Station, service: str, said: Callable[[], None]) -> None:
        self._station, self._service, self._said = station, service, said
        self._subscription: Any = None
        self._names: list[str] = []
        self._ends: set[tuple[int, ...]] = set()
        self._warnings: deque[tuple[float, str]] = deque(maxlen=1000)

    def listen(self) -> None:
        """Notice which node offers the service now, and listen to its warnings."""
        self._names = self._offering()
        self._ends = self._rosout_ends()
        if self._subscription is None:
            from rcl_interfaces.msg import Log

            node, loop = self._station.node, self._station.loop
            self._subscription = node.create_subscription(
                Log, "/rosout", lambda message: loop.now_or_soon(self._hear, message), 1000
            )

    def close(self) -> None:
        """Listen no more."""
        if self._subscription is not None:
            self._station.node.destroy_subscription(self._subscription)
            self._subscription = None

    def is_there(self) -> bool:
        """Whether it is the one that was there when `listen` was called: started again, it has forgotten all calls."""
        return bool(self._offering()) and self._ends <= self._rosout_ends()

    def why(self, called: float, answered: float, *, last: bool) -> str:
        """What it warned of between a call and its answer (robot time, s), or "". A warning is given out once.

        Of several, one about a goal is preferred; then the first, or the `last`.
        """
        found = [each for each in self._warnings if called - SLACK <= each[0] <= answered + SLACK]
        found = [each for each in found if "goal" in each[1].lower()] or found
        if not found:
            return ""
        chosen = found[-1 if last else 0]
        self._warnings.remove(chosen)
        return _shortened(chosen[1])

    def _hear(self, message: Any) -> None:
        names = [name.strip("/").replace("/", ".") for name in self._names]
        if message.level >= WARNING and any(f"{message.name}.".startswith(f"{name}.") for name in names):
            stamp = message.stamp.sec * 1_000_000_000 + message.stamp.nanosec
            self._warnings.append((self._station.recorder.seconds(stamp), message.msg))
            self._said()

    def _offering(self) -> list[str]:
        node = self._station.node
        return [
            f"{namespace.rstrip('/')}/{name}"
            for name, namespace in node.get_node_names_and_namespaces()
            if self._service in _services(node, name, namespace)
        ]

    def _rosout_ends(self) -> set[tuple[int, ...]]:
        """What tells this very node from the next one of its name: the end with which it publishes its log."""
        return {
            tuple(end.endpoint_gid)
            for end in self._station.node.get_publishers_info_by_topic("/rosout")
            if f"{end.node_namespace.rstrip('/')}/{end.node_name}" in self._names
        }


def _services(node: Any, name: str, namespace: str) -> list[str]:
    from rclpy.node import NodeNameNonExistentError

    try:
        return [service for service, _ in node.get_service_names_and_types_by_node(name, namespace)]
    except NodeNameNonExistentError:  # gone since the list was made
        return []


def _shortened(warning: str) -> str:
    """A warning without "Goal refused:" in front, since the state says that already; with a capital and a full stop."""
    head, colon, rest = warning.partition(": ")
    text = rest if colon and head.lower().startswith("goal") else warning
    return f"{text[:1].upper()}{text[1:]}".rstrip(".") + "."
