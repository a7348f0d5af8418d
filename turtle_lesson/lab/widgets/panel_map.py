"""The panel with the map: the world from above, with the turtle, its trail, the obstacles and what the laser hits."""

from __future__ import annotations

from typing import Any

import numpy as np
import traitlets

from ...turtlesim.obstacles import Box
from ..obstacle_board import Obstacle
from ..recording import UNDER_WAY
from .live_widget import LiveWidget
from .packing import pack
from .trail import Trail

STALE = 1.5
"""A scan of more robot time ago than this, s, is no longer drawn on the map."""


class MapPanel(LiveWidget):
    """Shows the world as the topics tell of it."""

    pose = traitlets.Bytes().tag(sync=True)
    """x, y, theta, speed (m, rad, m/s); not-a-number where none was heard."""
    trail = traitlets.Bytes().tag(sync=True)
    """The turtle's way: x, y, x, y, …, m; two not-a-numbers where it was put elsewhere."""
    tail = traitlets.Bytes().tag(sync=True)
    """The newest part of its way, which follows on `trail`."""
    scan = traitlets.Bytes().tag(sync=True)
    """The newest scan: angle_min, angle_increment (rad), range_max (m), then the distances (m)."""
    scanned_from = traitlets.Bytes().tag(sync=True)
    """Where the turtle was at that scan: x, y, theta (m, rad); empty when that was too long ago."""
    obstacles = traitlets.List(traitlets.Dict()).tag(sync=True)
    """"shape" ("circle" or "box"), x, y, width, height (m), angle (rad) of each."""

    def __init__(self, *arguments: Any, **traits: Any) -> None:
        super().__init__(*arguments, **traits)
        self._way = Trail(self.station.recorder.poses)
        self._scan_drawn: Any = None

    def tick(self) -> None:
        """Read what was heard."""
        super().tick()
        poses = self.station.recorder.poses.newest(1)
        self.pose = pack([poses[0][name] for name in ("x", "y", "theta", "speed")] if len(poses) else [np.nan] * 4)
        self._way.grow()
        self.trail, self.tail = self._way.whole, self._way.tail
        self._show_scan()
        self.obstacles = [as_state(each) for each in self.station.board.obstacles]

    def left(self) -> None:
        """Draw no more."""
        super().left()
        del self._way

    def _show_scan(self) -> None:
        recorder = self.station.recorder
        scan = recorder.last_scan
        if scan is None:
            return
        stamp = recorder.scans.newest(1)["stamp"][0]
        if self.station.now - recorder.seconds(stamp) > STALE:
            self.scanned_from = b""
        elif scan is not self._scan_drawn:
            self._scan_drawn = scan
            self.scan = pack([scan.angle_min, scan.angle_increment, scan.range_max, *scan.ranges])
            rows = recorder.poses.newest(2000)
            rows = rows[rows["stamp"] <= stamp - UNDER_WAY]  # or a turtle that turns would see walls beside the walls
            self.scanned_from = pack([rows[-1][name] for name in ("x", "y", "theta")]) if len(rows) else b""


def as_state(obstacle: Obstacle) -> dict[str, Any]:
    """What the browser is told of an obstacle."""
    place = {"x": obstacle.x, "y": obstacle.y}
    if isinstance(obstacle, Box):
        return {"shape": "box", **place, "width": obstacle.width, "height": obstacle.height, "angle": obstacle.angle}
    return {"shape": "circle", **place, "width": 2 * obstacle.radius, "height": 2 * obstacle.radius, "angle": 0.0}
