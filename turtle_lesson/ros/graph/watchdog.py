"""Something that has to happen again within a span of time, or else …"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..core import Simulation

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
