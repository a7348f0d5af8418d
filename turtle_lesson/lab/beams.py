"""The beams of a laser scan: their angles, and which of them see something."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

AHEAD = math.radians(30)
"""Up to this angle to either side, a reading counts as ahead."""

BESIDE = math.radians(90.5)
"""From there to this angle it counts as beside, and beyond it as behind."""


@dataclass(frozen=True)
class Beams:
    """Angles in rad (0 is ahead, positive to the left), ranges in m, and which beams see something.

    `least` and `most` bound the ranges that the sensor can tell; `asked` is the number of readings that its
    angles ask for.
    """

    angles: np.ndarray
    ranges: np.ndarray
    sees: np.ndarray
    least: float
    most: float
    asked: int

    def __len__(self) -> int:
        return len(self.ranges)

    @property
    def whole(self) -> bool:
        """Whether the sensor also looks back."""
        return bool((np.abs(self.angles) > math.radians(100)).any())

    def nearest(self, among: np.ndarray | None = None) -> int | None:
        """The index of the beam with the nearest thing, of several the one closest to ahead; or None."""
        seeing = np.flatnonzero(self.sees if among is None else self.sees & among)
        if not len(seeing):
            return None
        order = np.lexsort((np.abs(self.angles[seeing]), self.ranges[seeing].round(6)))
        return int(seeing[order[0]])

    def nearest_by_side(self) -> dict[str, int]:
        """The nearest beam to the right, ahead, to the left and behind, where any sees something there."""
        turn = np.remainder(self.angles + math.pi, math.tau) - math.pi
        sides = {
            "right": (turn < -AHEAD) & (turn >= -BESIDE),
            "ahead": np.abs(turn) <= AHEAD,
            "left": (turn > AHEAD) & (turn <= BESIDE),
            "behind": np.abs(turn) > BESIDE,
        }
        best = {side: self.nearest(among) for side, among in sides.items()}
        return {side: beam for side, beam in best.items() if beam is not None}


def read_beams(scan: Any) -> Beams:
    """Return the beams of a sensor_msgs/msg/LaserScan.

    As that message's definition says, a range below range_min or above range_max, or no number at all, is to
    be discarded. A range of range_max itself is what a detector reports that sees nothing.
    """
    ranges = np.asarray(scan.ranges, float)
    angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
    sees = np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges < scan.range_max - 1e-6)
    return Beams(angles, ranges, sees, scan.range_min, scan.range_max, _asked(scan))


def _asked(scan: Any) -> int:
    """How many readings min, max and increment ask for; float32 steps may fall a little short."""
    span = scan.angle_max - scan.angle_min
    if not scan.angle_increment or not math.isfinite(span / scan.angle_increment):
        return 1
    return max(math.floor(span / scan.angle_increment + 1e-3) + 1, 0)
