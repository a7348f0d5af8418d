"""What has happened to one end of a topic, counted until somebody takes note of it.

Facts: the status structs of rmw's events_statuses folder. Each `take` answers the fields of one, in their order.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .latency import nobody

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
