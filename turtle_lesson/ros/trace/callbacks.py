"""When one callback of a node ran: ready, begun, ended."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

import numpy as np

RUN = np.dtype([("ready", "=i8"), ("began", "=i8"), ("ended", "=i8")])
"""Times in ns since the world's start: the message, request or tick was there; its callback began; it returned."""

LIMIT = 30_000
"""How many runs of one callback are kept, the newest: eight minutes of a turtle's pose, some 4 MB."""

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
        arrivals: when each message or request came that waits now (ns); None for a timer.
        open: of the runs that have not ended, when they were ready and began (ns).
        ended: the runs that are over, in the order in which they ended.
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
    ended: deque[Run] = field(default_factory=lambda: deque(maxlen=LIMIT))

    def runs(self, now: int) -> np.ndarray:
        """All runs, of type `RUN`, in the order in which they began; what goes on ends `now` (ns)."""
        rows = np.array([*self.ended, *((*run, now) for run in self.open)], RUN)
        return rows[np.argsort(rows["began"], kind="stable")]
