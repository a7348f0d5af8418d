"""The way from one publisher to one subscription: how long messages take, and what becomes of them on the way."""

from __future__ import annotations

import zlib
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from itertools import takewhile
from random import Random
from typing import Any

from ..sim.simulation import Simulation
from .network import Conditions, Network

# -- lines --------------------------------------------------------------------------------------------------------
# The way from one publisher to one subscription, wherever it is not the usual one.
# The rules, which are those of RTPS (the protocol under DDS; chapters 8.4.8 to 8.4.12) in short:
# * Best effort: what is lost is lost, and a message that was overtaken by a later one is thrown away. * Reliable: a
# lost transmission is noticed and repeated two ways and 10 ms later (and may be lost again), as long as the publisher
# still has the message: with KEEP_LAST that is one of its last `depth`. Messages arrive in their order, so one that
# is missing holds up those behind it until it comes, or until the publisher has given it up. * A subscription learns
# of a loss when it sees the gap: with the next message that arrives.

NOTICED_AFTER = 10_000_000
"""How long it takes, in ns and beside two ways, until a lost message is asked for and sent again: the delays that DDS
implementations have for their answers to heartbeats are 5 to 10 ms."""

USUAL = Conditions()
Deliver = Callable[[Any, int], object]
"""Gets what has arrived, and when it was sent (ns)."""


@dataclass(slots=True, eq=False)
class _Parcel:
    """A message on its way, and when it was published (ns): it will be here when it is `due` (ns), is here, or given up."""

    wire: Any
    sent: int
    due: int | None = None
    here: bool = False
    given_up: bool = False

    @property
    def missing(self) -> bool:
        """Whether its last transmission was lost, and the publisher still has it."""
        return self.due is None and not self.here and not self.given_up


class Line:
    """Base class: `deliver` gets what arrives, `told` how many messages are known to be lost.

    `depth` is how many messages the sender keeps, None for all. Subclasses say what becomes of a lost transmission.
    """

    def __init__(
        self,
        simulation: Simulation,
        latency: int,
        deliver: Deliver,
        told: Callable[[int], object],
        network: Network,
        ends: str,
        depth: int | None = None,
    ) -> None:
        self._simulation = simulation
        self._usual = latency
        self._deliver = deliver
        self._told = told
        self._network = network
        self._ends = ends
        self._depth = depth
        self._random: Random | None = None
        self._parcels: deque[_Parcel] = deque()
        self._gap = 0
        self.conditions = USUAL

    def use(self, conditions: Conditions | None) -> None:
        """Have what is sent from now on travel under these conditions; None for the usual ones."""
        self.conditions = conditions or USUAL
        if self._random is None and (self.conditions.loss or self.conditions.jitter):
            self._random = self._network.random(self._ends)

    def send(self, wire: Any, sent: int) -> None:
        """Take a message (a copy of its own) that was published at `sent` (ns)."""
        parcel = _Parcel(wire, sent)
        self._parcels.append(parcel)
        self._transmit(parcel)

    def under_way(self) -> list[tuple[int, Any]]:
        """What has been sent and will arrive, as far as that is known: when it was published (ns), and the message."""
        return [(each.sent, each.wire) for each in self._parcels if each.here or each.due is not None]

    def is_busy(self) -> bool:
        """Whether something has not arrived yet, as far as that will ever be known."""
        return bool(self._parcels)

    def close(self) -> None:
        """The subscription has gone: deliver nothing more."""
        self._deliver = self._told = nobody
        self._parcels.clear()

    def _way(self) -> int:
        """How long a transmission takes now, in ns: never less than in the usual network."""
        conditions = self.conditions
        longer = max(0, conditions.latency - LATENCY)
        if conditions.jitter and self._random is not None:
            longer += int(self._random.random() * conditions.jitter)
        return self._usual + longer

    def _transmit(self, parcel: _Parcel) -> None:
        loss = self.conditions.loss
        if loss > 0 and self._random is not None and self._random.random() < loss:
            parcel.due = None
            self._is_lost(parcel)
        else:
            parcel.due = self._simulation.now + self._way()
            self._simulation.at(parcel.due, self._arrive, parcel)

    def _is_lost(self, parcel: _Parcel) -> None:
        """This transmission of a message was lost."""
        raise NotImplementedError

    def _arrive(self, parcel: _Parcel) -> None:
        parcel.due, parcel.here = None, True
        self._hand_over()

    def _hand_over(self) -> None:
        """Deliver, in their order, what is here and waits for nothing before it."""
        parcels = self._parcels
        while parcels and (parcels[0].here or parcels[0].given_up):
            parcel = parcels.popleft()
            if parcel.given_up:
                self._gap += 1
                continue
            if self._gap:
                gap, self._gap = self._gap, 0
                self._told(gap)
            self._deliver(parcel.wire, parcel.sent)


class BestEffortLine(Line):
    """What is lost is lost, and so is what was overtaken."""

    def _is_lost(self, parcel: _Parcel) -> None:
        parcel.given_up = True
        self._hand_over()

    def _arrive(self, parcel: _Parcel) -> None:
        if parcel.given_up:
            return
        for earlier in takewhile(lambda each: each is not parcel, self._parcels):
            earlier.given_up, earlier.due = True, None
        super()._arrive(parcel)


class ReliableLine(Line):
    """What is lost is sent again."""

    _asks = False

    def use(self, conditions: Conditions | None) -> None:
        """See Line. Where nothing came through, what is missing is asked for anew."""
        super().use(conditions)
        if any(parcel.missing for parcel in self._parcels):
            self._ask_again()

    def send(self, wire: Any, sent: int) -> None:
        """See Line."""
        parcel = _Parcel(wire, sent)
        self._parcels.append(parcel)
        self._give_up_old_ones()
        self._transmit(parcel)

    def _is_lost(self, parcel: _Parcel) -> None:
        self._ask_again()

    def _ask_again(self) -> None:
        """Have what is missing sent again some time later; where nothing comes through, nobody asks."""
        if not self._asks and self.conditions.loss < 1:
            self._asks = True
            self._simulation.at(self._simulation.now + 2 * self._way() + NOTICED_AFTER, self._repeat, None)

    def _repeat(self, _: object) -> None:
        self._asks = False
        for parcel in [each for each in self._parcels if each.missing]:
            self._transmit(parcel)
        self._hand_over()
        if any(parcel.missing for parcel in self._parcels):
            self._ask_again()

    def _give_up_old_ones(self) -> None:
        """With KEEP_LAST the sender has overwritten what is too old: what is missing of it can never be sent again."""
        if self._depth is None:
            return
        parcels = self._parcels
        for index in range(len(parcels) - self._depth):
            if parcels[index].missing:
                parcels[index].given_up = True
                self._ask_again()
        while parcels[0].given_up:
            parcels.popleft()
            self._gap += 1


# -- latency ------------------------------------------------------------------------------------------------------

LATENCY = 100_000
"""How long a message is under way, in ns: what a real rclpy needs from publish to callback is 81 to 107 µs. Each
name has its own few µs on top, so that of two messages sent at the same instant the order never depends on chance."""

LATENCY_SPREAD = 20_000


def latency_of(name: str) -> int:
    """The time, in ns, that messages of a topic (or requests of a service) are under way: fixed for each name.

    The topics and services behind an action share one, so that its result does not overtake its feedback.
    """
    return LATENCY + zlib.crc32(name.partition("/_action/")[0].encode()) % LATENCY_SPREAD


def nobody(*_: object) -> None:
    """What is told when nobody waits to be told: the other end has gone, or does not listen yet."""
