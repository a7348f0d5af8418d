"""The panel with the map: the world from above, with the turtle, its trail, the obstacles and what the laser hits."""

from __future__ import annotations

import numpy as np
import traitlets

from .live_widget import LiveWidget
from .packing import pack

TRAIL = 500
"""Points of the trail that are shown at most."""


class MapPanel(LiveWidget):
    """Shows the world as the topics tell of it."""

    pose = traitlets.Bytes().tag(sync=True)
    """x, y, theta, speed (m, rad, m/s); not-a-number where none was heard."""
    trail = traitlets.Bytes().tag(sync=True)
    """The turtle's way: x, y, x, y, …, m."""
    scan = traitlets.Bytes().tag(sync=True)
    """The newest scan: angle_min, angle_increment (rad), range_max (m), then the distances (m)."""
    obstacles = traitlets.List(traitlets.Dict()).tag(sync=True)

    def tick(self) -> None:
        """Read what was heard."""
        super().tick()
        recorder = self.station.recorder
        poses = recorder.poses.array()
        self.pose = pack([poses[-1][name] for name in ("x", "y", "theta", "speed")] if len(poses) else [np.nan] * 4)
        way = poses[:: max(1, len(poses) // TRAIL)]
        self.trail = pack(np.column_stack([way["x"], way["y"]]))
        scan = recorder.last_scan
        if scan is not None:
            self.scan = pack([scan.angle_min, scan.angle_increment, scan.range_max, *scan.ranges])
        self.obstacles = [
            {name: getattr(each, name) for name in ("shape", "x", "y", "width", "height", "angle")}
            for each in recorder.obstacles.values()
        ]
