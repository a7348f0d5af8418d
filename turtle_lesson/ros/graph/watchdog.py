"""Something that has to happen again within a span of time, or else …"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..core import Simulation


class Watchdog:
    """Calls `alarm()` when more than `span` ns pass after a `renew()`; with `repeats` after each further span, too.

    Renewing is cheap: one event is under way at a time, and looks when it comes whether it is still wanted. Exactly one
    span is no delay: in a world without jitter a timer of that period would otherwise always be late.
    """

    def __init__(self, simulation: Simulation, span: int, alarm: Callable[[], object], repeats: bool) -> None:
        self._simulation = simulation
        self._span = span
        self._alarm = alarm
        self._repeats = repeats
        self._due: int | None = None
        self._looks = False

    def renew(self, _: object = None) -> None:
        """It has happened: wait for the next time. The first call begins the watch."""
        due = self._due = self._simulation.now + self._span
        if not self._looks:
            self._looks = True
            self._simulation.at(due + 1, self._look, None)

    def stop(self) -> None:
        """Wait no longer, until it happens again."""
        self._due = None

    def _look(self, _: object) -> None:
        self._looks = False
        due = self._due
        if due is not None and self._simulation.now > due:
            self._due = due + self._span if self._repeats else None
            self._alarm()
        if self._due is not None and not self._looks:
            self._looks = True
            self._simulation.at(self._due + 1, self._look, None)
