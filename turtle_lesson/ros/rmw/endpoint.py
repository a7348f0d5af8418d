"""What publishers and subscriptions share: quality of service, leases and deadlines, and the status of QoS events."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .transport import nobody

if TYPE_CHECKING:
    from ..sim.simulation import Simulation
    from .graph import NodeEntry
    from .topic import Topic


# -- end ----------------------------------------------------------------------------------------------------------
# What publishers and subscriptions have in common: their place in the graph, and what has happened to them.


class End:
    """One end of a topic. `tallies` holds what somebody listens to, by kind (see tally.py); the rest is not counted."""

    def __init__(self, node: NodeEntry, topic: Topic, quality: Quality) -> None:
        self.node = node
        self.topic = topic
        self.quality = quality
        self.profile: Any = None
        """The profile that the program gave, for displays of this end."""
        self.tallies: dict[str, Tally] = {}

    def listen(self, kind: str) -> Tally:
        """Count from now on, or go on counting, how often something of this kind happens.

        What has happened already is reported to the first listener.
        """
        tally = self.tallies.get(kind)
        if tally is None:
            tally = self.tallies[kind] = self._tally_of(kind)
            if tally.news:
                self.topic.simulation.at(self.topic.soon, _tell, tally)
        return tally

    def happens(self, kind: str, what: Any = 1) -> None:
        """Something happens to this end now."""
        tally = self.tallies.get(kind)
        if tally is not None:
            tally.add(what)

    def will_happen(self, kind: str, what: Any = 1) -> None:
        """This end learns of something that has just happened to the other one, as soon as messages take to arrive."""
        if kind in self.tallies:
            self.topic.simulation.at(self.topic.soon, self._learn, (kind, what))

    def _learn(self, news: tuple[str, Any]) -> None:
        self.happens(*news)

    def is_refused(self, kind: str, what: Any = 1) -> None:
        """This end meets one that it cannot be connected with. Told a moment later, when somebody listens."""
        self.topic.simulation.at(self.topic.soon, self._learn, (kind, what))

    def connections(self) -> int:
        """With how many ends of the other side this one is connected."""
        raise NotImplementedError

    def _tally_of(self, kind: str) -> Tally:
        if kind == INCOMPATIBLE_QOS:
            return Refusals()
        if kind == MATCHED:
            return begun(Matches(), self.connections(), self.connections())
        return Tally()


def begun(pair: Any, first: int, second: int) -> Any:
    """A pair of numbers that begins with what is there already."""
    pair.move(first, second)
    pair.news = bool(first or second)
    return pair


def _tell(tally: Tally) -> None:
    if tally.news:
        tally.tell()


# -- quality ------------------------------------------------------------------------------------------------------
# Quality of service: what a writer offers, what a reader requests, and whether the two go together.
# Facts: https://docs.ros.org/en/humble/Concepts/Intermediate/About-Quality-of-Service-Settings.html
# (compatibilities); of several policies that do not go together, the first in the order of Cyclone DDS
# (ddsi_qosmatch.c) is named.


@dataclass(frozen=True)
class Quality:
    """The policies that decide about delivery. Spans are in ns, None for endless.

    `depth` is the queue's length, None to keep all; `manual` is liveliness that the program itself asserts.
    """

    depth: int | None = 10
    reliable: bool = True
    latched: bool = False
    deadline: int | None = None
    lifespan: int | None = None
    manual: bool = False
    lease: int | None = None

    def refusal(self, requested: Quality) -> str | None:
        """The policy of this offer that a request cannot accept, by its ROS name, or None."""
        if requested.reliable and not self.reliable:
            return "RELIABILITY"
        if requested.latched and not self.latched:
            return "DURABILITY"
        if _shorter(requested.deadline, self.deadline):
            return "DEADLINE"
        if (requested.manual and not self.manual) or _shorter(requested.lease, self.lease):
            return "LIVELINESS"
        return None


def _shorter(requested: int | None, offered: int | None) -> bool:
    """Whether a span that is requested is shorter than the one that is offered."""
    return requested is not None and (offered is None or requested < offered)


# -- tally --------------------------------------------------------------------------------------------------------
# What has happened to one end of a topic, counted until somebody takes note of it.
# Facts: the status structs of rmw's events_statuses folder. Each `take` answers the fields of one, in their order.

DEADLINE = "deadline"
LIVELINESS = "liveliness"
INCOMPATIBLE_QOS = "incompatible_qos"
INCOMPATIBLE_TYPE = "incompatible_type"
MESSAGE_LOST = "message_lost"
MATCHED = "matched"


class Tally:
    """How often something has happened. `wake` is called whenever there is news."""

    def __init__(self) -> None:
        self.total = 0
        self.change = 0
        self.news = False
        self.wake: Callable[[], object] = nobody

    def add(self, count: Any = 1) -> None:
        """It has happened again."""
        self.total += count
        self.change += count
        self.tell()

    def tell(self) -> None:
        """Wake the waiting callers."""
        self.news = True
        self.wake()

    def take(self) -> tuple[Any, ...]:
        """Total, and how much of it is new since the last look."""
        self.news = False
        counts = (self.total, self.change)
        self.change = 0
        return counts


class Refusals(Tally):
    """How many ends of the other side could not be accepted, and because of which policy the last one was not."""

    def __init__(self) -> None:
        super().__init__()
        self.policy = "INVALID"

    def add(self, policy: Any = "INVALID") -> None:
        """One more, because of this policy."""
        self.policy = policy
        super().add()

    def take(self) -> tuple[Any, ...]:
        """Total, change, and the policy's ROS name."""
        return (*super().take(), self.policy)


class Pair(Tally):
    """Two numbers that go up and down together with how much they have changed."""

    def __init__(self) -> None:
        super().__init__()
        self._now = [0, 0]
        self._changes = [0, 0]

    def move(self, first: int, second: int) -> None:
        """Both numbers change by so much."""
        for index, step in enumerate((first, second)):
            self._now[index] += step
            self._changes[index] += step

    def add(self, change: Any = (0, 0)) -> None:
        """A pair of changes has happened."""
        self.move(*change)
        self.tell()

    def take(self) -> tuple[Any, ...]:
        """Both numbers, then their changes since the last look."""
        self.news = False
        counts = (*self._now, *self._changes)
        self._changes = [0, 0]
        return counts


class Matches(Pair):
    """How many ends of the other side this one has ever been connected with, and with how many it is now."""

    def take(self) -> tuple[Any, ...]:
        """Total, its change, current, its change."""
        total, current, total_change, current_change = super().take()
        return (total, total_change, current, current_change)


# -- watchdog -----------------------------------------------------------------------------------------------------
# Something that has to happen again within a span of time, or else …

FINEST = 1_000_000
"""How often (ns) somebody is told at most: of shorter spans, several at once."""


class Watchdog:
    """Calls `alarm(1)` when more than `span` ns pass after a `renew()`; with `repeats` for each further span, too.

    Renewing is cheap: one event is under way at a time, and looks when it comes whether it is still wanted. Exactly one
    span is no delay: in a world without jitter a timer of that period would otherwise always be late.
    """

    def __init__(self, simulation: Simulation, span: int, alarm: Callable[[int], object], repeats: bool) -> None:
        self._simulation = simulation
        self._span = span
        self._alarm = alarm
        self._repeats = repeats
        self._due: int | None = None
        self._looks = False

    def renew(self, _: object = None) -> None:
        """It has happened: wait for the next time. The first call begins the watch."""
        now = self._simulation.now
        if self._due is not None and now > self._due:
            self._tell(now, self._due)
        self._due = now + self._span
        if not self._looks:
            self._look_at(self._due + 1)

    def stop(self) -> None:
        """Wait no longer, until it happens again."""
        self._due = None

    def _look_at(self, time: int) -> None:
        self._looks = True
        self._simulation.at(time, self._look, None)

    def _look(self, _: object) -> None:
        self._looks = False
        now, soonest = self._simulation.now, 0
        if self._due is not None and now > self._due:
            self._tell(now, self._due)
            soonest = now + FINEST
        if self._due is not None and not self._looks:
            self._look_at(max(self._due + 1, soonest))

    def _tell(self, now: int, due: int) -> None:
        """How many spans are over now, since the one that was over at `due`."""
        count = (now - due - 1) // self._span + 1 if self._repeats else 1
        self._due = due + count * self._span if self._repeats else None
        self._alarm(count)
