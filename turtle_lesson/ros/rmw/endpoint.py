"""What publishers and subscriptions share: quality of service, leases and deadlines, and the status of QoS events."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from operator import add
from typing import TYPE_CHECKING, Any

from .transport import nobody

if TYPE_CHECKING:
    from ..sim.simulation import Simulation
    from .graph import NodeEntry, Topic


class End:
    """One end of a topic. `tallies` holds what somebody listens to, by kind; the rest is not counted."""

    def __init__(self, node: NodeEntry, topic: Topic, quality: Quality) -> None:
        self.node = node
        self.topic = topic
        self.quality = quality
        self.profile: Any = None
        """The profile that the program gave, for displays of this end."""
        self.tallies: dict[str, Tally] = {}
        self.last_policy = "INVALID"
        """The name of the policy because of which another end was refused last."""
        self._deadline: Watchdog | None = None

    def listen(self, kind: str) -> Tally:
        """Count from now on, or go on counting, how often something of this kind happens.

        What has happened already is news for the first listener. One for missed deadlines has the messages watched, from the
        next one on.
        """
        if kind not in self.tallies:
            tally = self.tallies[kind] = self._tally_of(kind)
            if kind == DEADLINE and self.quality.deadline is not None:
                self._deadline = Watchdog(self.topic.simulation, self.quality.deadline, tally.add, repeats=True)
                self.arrange()
        return self.tallies[kind]

    def arrange(self) -> None:
        """Decide again what is done with each message."""
        raise NotImplementedError

    def happens(self, kind: str, *steps: int) -> None:
        """Something happens to this end now."""
        tally = self.tallies.get(kind)
        if tally is not None:
            tally.add(*steps)

    def will_happen(self, kind: str, *steps: int) -> None:
        """This end learns of something that has just happened to the other one, as soon as messages take to arrive."""
        if kind in self.tallies:
            self.topic.simulation.at(self.topic.soon, self._learn, (kind, *steps))

    def is_refused(self, policy: str | None) -> None:
        """This end meets one of another type, or whose policy of this name does not fit. Told a moment later."""
        self.topic.simulation.at(self.topic.soon, self._learn_refusal, policy)

    def _learn(self, news: tuple[Any, ...]) -> None:
        self.happens(*news)

    def _learn_refusal(self, policy: str | None) -> None:
        self.last_policy = policy or self.last_policy
        self.happens(INCOMPATIBLE_QOS if policy else INCOMPATIBLE_TYPE, 1)

    def connections(self) -> int:
        """With how many ends of the other side this one is connected."""
        raise NotImplementedError

    def _tally_of(self, kind: str) -> Tally:
        return Tally(self.connections(), self.connections()) if kind == MATCHED else Tally(0)


# -- quality ------------------------------------------------------------------------------------------------------
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
# Facts: the status structs of rmw's events_statuses folder. Each `take` answers the fields of one, in their order.

DEADLINE = "deadline"
LIVELINESS = "liveliness"
INCOMPATIBLE_QOS = "incompatible_qos"
INCOMPATIBLE_TYPE = "incompatible_type"
MESSAGE_LOST = "message_lost"
MATCHED = "matched"


class Tally:
    """Numbers that count what happens, beginning with what is there already. `wake` is called whenever there is news."""

    def __init__(self, *numbers: int) -> None:
        self._numbers = self._changes = numbers
        self.news = any(numbers)
        self.wake: Callable[[], object] = nobody

    def add(self, *steps: int) -> None:
        """It has happened: the numbers change by so much."""
        self._numbers = tuple(map(add, self._numbers, steps))
        self._changes = tuple(map(add, self._changes, steps))
        self.news = True
        self.wake()

    def take(self) -> tuple[int, ...]:
        """The numbers, then their changes since the last look."""
        taken = (*self._numbers, *self._changes)
        self._changes = (0,) * len(self._numbers)
        self.news = False
        return taken


# -- watchdog -----------------------------------------------------------------------------------------------------

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
