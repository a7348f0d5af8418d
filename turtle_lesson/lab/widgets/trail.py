"""The turtle's trail on a live map, grown point by point and sent to the browser in two parts."""

from __future__ import annotations

import math
from itertools import islice
from typing import Any

import numpy as np

from ..table import Table
from ..track import find_jumps
from .packing import pack

SPACING = 0.05
"""Metres from one point of the trail to the next; the browser itself joins the last one to the turtle."""
POINTS = 600
"""How many points are kept: 30 m of way."""
TAIL = 60
"""How many points may be new until the whole trail is sent again."""

Point = tuple[float, float]
GAP: Point = (math.nan, math.nan)


class Trail:
    """The newest metres of the way that a table of poses tells. `whole` rarely changes, `tail` is short."""

    def __init__(self, poses: Table) -> None:
        self._poses = poses
        self._last: Any = None
        self._points: list[Point] = []
        self._new: list[Point] = []
        self.whole = self.tail = b""

    def grow(self) -> None:
        """Add what has come since the last time."""
        rows = self._fresh_rows()
        if len(rows) < 2:
            return
        self._last = rows[-1:].copy()
        jumps = set(find_jumps(rows).tolist())
        before = len(self._new)
        places = zip(rows["x"].tolist(), rows["y"].tolist(), strict=True)
        for number, (x, y) in enumerate(islice(places, 1, None), start=1):
            self._add(x, y, number in jumps)
        if len(self._new) != before:
            self._pack()

    def _fresh_rows(self) -> np.ndarray:
        """The last row that was used, and those after it; all rows when there was none."""
        if self._last is None:
            rows = self._poses.array()
            if len(rows):
                self._last = rows[:1]
                self._add(float(rows["x"][0]), float(rows["y"][0]), False)
            return rows
        stamp, count = self._last["stamp"][0], 16
        while True:
            rows = self._poses.newest(count)
            if len(rows) < count or rows["stamp"][0] <= stamp:
                return np.concatenate([self._last, rows[rows["stamp"] > stamp]])
            count *= 4

    def _add(self, x: float, y: float, jumped: bool) -> None:
        if not (math.isfinite(x) and math.isfinite(y)):
            return
        points = self._new or self._points
        if jumped:
            self._new += [GAP, (x, y)]
        elif not points or math.hypot(x - points[-1][0], y - points[-1][1]) >= SPACING:
            self._new.append((x, y))

    def _pack(self) -> None:
        if len(self._new) > TAIL or not self.whole:
            self._points = [*self._points, *self._new][-POINTS:]
            self._new = []
            self.whole = pack(self._points)
        self.tail = pack(self._new)
