"""The trace of one world, and what fills it."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .callbacks import Callback
from .calls import Call

if TYPE_CHECKING:
    from ..core import Simulation
    from ..graph import NodeEntry

MESSAGES = 50_000
"""How many messages of each publisher are kept, the newest: 13 minutes of a turtle's pose."""

TOPICS = 32
"""On how many topics a node's messages are noted, the first ones: of a thousand turtles nobody plots them all."""

CALLS = 1_000

LINES = 500

PLUMBING = frozenset({"/rosout", "/parameter_events"})


class Trace:
    """What happened in a world since its start. Hidden nodes and what ROS does for itself are left out."""

    def __init__(self, simulation: Simulation) -> None:
        self.simulation = simulation
        self.published: dict[tuple[str, str], deque[int]] = {}
        """By topic and node (full names), when each message was published (ns)."""
        self.made: dict[tuple[str, str], int] = {}
        """By the same, when the newest publisher was made (ns)."""
        self.not_noted: set[str] = set()
        """Topics beyond the first ones of their publishers' nodes."""
        self._topics: Counter[str] = Counter()
        self.callbacks: list[Callback] = []
        self.calls: deque[Call] = deque(maxlen=CALLS)
        self.log: deque[tuple[int, int, str, str]] = deque(maxlen=LINES)
        """Time (ns), level (10, 20 … as in /rosout), logger and text of the newest lines that nodes have logged."""

    @property
    def now(self) -> int:
        """The time in ns since the world's start."""
        return self.simulation.now

    def publisher(self, node: NodeEntry, topic: str) -> Callable[[int], None] | None:
        """What a new publisher tells the time of each message, if it is to tell it."""
        if node.hidden or topic in PLUMBING:
            return None
        times = self.published.get((topic, node.full_name))
        if times is None:
            self._topics[node.full_name] += 1
            if self._topics[node.full_name] > TOPICS:
                self.not_noted.add(topic)
                return None
            times = self.published[topic, node.full_name] = deque(maxlen=MESSAGES)
        self.made[topic, node.full_name] = self.now
        return times.append

    def asked(self, client: Any, message: Any) -> Call:
        """A client asks."""
        call = Call(client.name, client.type_name, caller_name(client.node), self.now, message)
        self.calls.append(call)
        return call

    def received(self, call: Call, server: NodeEntry) -> None:
        """A request has arrived at a server."""
        if call.received is not None:
            call.others += 1
            return
        call.server, call.process, call.received = server.full_name, server.process.pid, self.now

    def answered(self, call: Call, response: Any) -> None:
        """A server sends its answer. Only the first one counts, for the caller as for us."""
        if call.answered is None:
            call.answered, call.response = self.now, response

    def told(self, call: Call) -> None:
        """The answer has arrived."""
        if call.told is None:
            call.told = self.now


def caller_name(node: NodeEntry) -> str:
    """The caller: a node, or the command whose hidden node it is."""
    words = node.process.argv
    if node.hidden and words and words[0] == "ros2":
        return " ".join(words[:3])
    return node.full_name
