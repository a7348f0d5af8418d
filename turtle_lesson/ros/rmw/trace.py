"""A trace: what happened in a world, noted from outside, as ros2_tracing does on a robot."""

from __future__ import annotations

import struct
from collections import Counter, deque
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import chain
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np

    from ..sim.simulation import Simulation
    from .graph import NodeEntry
    from .service import ClientEnd

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

    def asked(self, client: ClientEnd, message: Any) -> Call:
        """A client asks."""
        node = client.node
        words = node.process.argv if node.hidden else []
        caller = " ".join(words[:3]) if words[:1] == ["ros2"] else node.full_name  # a command, or a node
        call = Call(client.name, client.type_name, caller, self.now, message)
        self.calls.append(call)
        return call

    def received(self, call: Call, server: NodeEntry) -> None:
        """A request has arrived at a server."""
        if call.received is None:  # of several servers of a name the first one counts
            call.server, call.process, call.received = server.full_name, server.process.pid, self.now

    def answered(self, call: Call, response: Any) -> None:
        """A server sends its answer. Only the first one counts, for the caller as for us."""
        if call.answered is None:
            call.answered, call.response = self.now, response

    def told(self, call: Call) -> None:
        """The answer has arrived."""
        if call.told is None:
            call.told = self.now


# -- callbacks ----------------------------------------------------------------------------------------------------

RUN = [("ready", "=i8"), ("began", "=i8"), ("ended", "=i8")]
"""Times in ns since the world's start: the message, request or tick was there; its callback began; it returned."""

LIMIT = 30_000
"""How many runs of one callback are kept, the newest: eight minutes of a turtle's pose, some 700 kB."""

CHUNK = 250
"""Runs that are packed at once: to keep each as a tuple of its own takes seven times the memory."""

Run = tuple[int, int, int]


@dataclass(eq=False)
class Callback:
    """A callback of a node, and all its runs.

    Attributes:
        node: the node's full name.
        name: the function's name.
        kind: what calls it: "timer", "subscription" or "service".
        source: the topic's or service's full name; nothing for a timer.
        period: a timer's period when it was made, in ns; otherwise 0.
        process: the number of the process that it runs in.
        awaits: whether it is an `async def`, which leaves its thread to others while it awaits.
        arrivals: when each message or request came that waits now (ns); None for a timer in the simulation's time.
        open: of the runs that have not ended, when they were ready and began (ns).
    """

    node: str
    name: str
    kind: str
    source: str
    period: int
    process: int
    awaits: bool
    arrivals: deque[int] | None = None
    open: list[tuple[int, int]] = field(default_factory=list)
    newest: list[Run] = field(default_factory=list)
    _packed: list[bytes] = field(default_factory=list)  # a deque takes half a kB while it is empty, as most stay

    def end_run(self, begun: tuple[int, int], now: int) -> None:
        """One of the open runs is over."""
        if self.open[-1] is begun:  # as nearly always: few callbacks run beside themselves
            self.open.pop()
        else:
            self.open.remove(begun)
        self.newest.append((begun[0], begun[1], now))
        if len(self.newest) == CHUNK:
            self.pack()

    def pack(self) -> None:
        """Pack the newest runs, which take less room so."""
        self._packed.append(struct.pack(f"={3 * CHUNK}q", *chain.from_iterable(self.newest)))
        self.newest.clear()
        del self._packed[: -(LIMIT // CHUNK)]

    @property
    def ended(self) -> list[Run]:
        """The runs that are over, in the order in which they ended."""
        return [*struct.iter_unpack("=3q", b"".join(self._packed)), *self.newest][-LIMIT:]

    def runs(self, now: int) -> np.ndarray:
        """All runs, of type `RUN`, in the order in which they began; what goes on ends `now` (ns)."""
        import numpy as np

        rows = np.array([*self.ended, *((*run, now) for run in self.open)], RUN)
        return rows[np.argsort(rows["began"], kind="stable")]


@dataclass(eq=False)
class Call:
    """One call of a service, from the question to the answer. Times are in ns since the world's start, None before it.

    Attributes:
        service, kind: the service's full name, and its type's.
        caller: the node that asked, by its full name; for a command its words.
        asked: when the request was sent.
        request: the request.
        server: the node that got the request, by its full name, and its process's number.
        received: when the request reached it.
        answered: when it sent its answer.
        response: the answer.
        told: when the answer reached the caller.
    """

    service: str
    kind: str
    caller: str
    asked: int
    request: Any
    server: str = ""
    process: int = 0
    received: int | None = None
    answered: int | None = None
    response: Any = None
    told: int | None = None
