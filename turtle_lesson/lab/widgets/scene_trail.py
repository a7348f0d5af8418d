"""The way that the turtle took, in as few points as show it well: straight stretches need only their ends."""

from __future__ import annotations

import math

import numpy as np

from ..table import Table
from ..track import find_jumps

STEP = 0.04
"""Points are at least so far apart, m …"""
STRETCH = 1.0
"""… and at most so far, m."""
BEND = 0.06
"""Between the two, there is a point where the way has turned by so much, rad."""

TIP, MOST = 24, 900
"""Points in the newest piece at most, and in all pieces together: the oldest go."""


class Trail:
    """The turtle's way from the poses in a table. `old` changes now and then, `tip` all the time."""

    def __init__(self, table: Table) -> None:
        self._table = table
        self._seen: np.ndarray | None = None
        self._here: np.ndarray | None = None
        self._turn = 0.0
        self._done: list[np.ndarray] = []
        self._tip: list[np.ndarray] = []
        self.changes = 0
        """How often `old` has changed."""

    @property
    def old(self) -> list[np.ndarray]:
        """The pieces that change no more: each n by 2, m."""
        return self._done

    @property
    def tip(self) -> np.ndarray:
        """The newest piece, to where the turtle is now: n by 2, m."""
        ahead = [] if self._here is None else [self._here]
        return np.array([*self._tip, *ahead]).reshape(-1, 2)

    def follow(self) -> bool:
        """Take in what was heard since the last time; returns whether there was anything new to draw."""
        rows = _after(self._table, None if self._seen is None else int(self._seen["stamp"][-1]))
        rows = rows[np.isfinite(rows["x"]) & np.isfinite(rows["y"])]
        if not len(rows):
            return False
        joined = rows if self._seen is None else np.concatenate([self._seen, rows])
        known = len(joined) - len(rows)
        jumps = set(find_jumps(joined).tolist()) if len(joined) > 1 else set()
        places = np.column_stack([joined["x"], joined["y"]])
        moved = self._here is None or bool((places[known:] != self._here).any())
        for index in range(known, len(places)):
            self._add(places[index], index in jumps)
        self._seen = joined[-1:]
        return moved

    def _add(self, place: np.ndarray, jumped: bool) -> None:
        if jumped:
            self._finish([])
        if not self._tip:
            self._tip.append(place)
        far, turn = _way(self._tip[-1], place)
        if far >= STEP:
            bent = abs(math.remainder(turn - self._turn, math.tau)) > BEND
            if len(self._tip) == 1 or far >= STRETCH:
                self._keep(place)
            elif bent:
                self._keep(place if self._here is None else self._here)
        self._here = place

    def _keep(self, place: np.ndarray) -> None:
        far, turn = _way(self._tip[-1], place)
        if not far:
            return
        self._tip.append(place)
        self._turn = turn
        if len(self._tip) >= TIP:
            self._finish([place])

    def _finish(self, begin: list[np.ndarray]) -> None:
        """The newest piece is done; another one begins."""
        if self._here is not None and not begin:
            self._tip.append(self._here)
        if len(self._tip) > 1:
            self._done.append(np.array(self._tip))
        while sum(map(len, self._done)) > MOST:
            del self._done[0]
        self._tip = begin
        self.changes += 1


def _way(begin: np.ndarray, end: np.ndarray) -> tuple[float, float]:
    """How far it is (m), and in which direction (rad)."""
    x, y = end - begin
    return math.hypot(x, y), math.atan2(y, x)


def _after(table: Table, stamp: int | None) -> np.ndarray:
    """The rows that are newer than `stamp`: without a copy of all rows each time."""
    if stamp is None:
        return table.array()
    count = 64
    while True:
        rows = table.newest(count)
        if len(rows) < count or rows["stamp"][0] <= stamp:
            return rows[rows["stamp"] > stamp]
        count *= 4
