"""A laser scan seen from above, forward up: the angles of its beams, range rings, and a dot where a beam hits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# -- fan ----------------------------------------------------------------------------------------------------------
# A scan drawn from above, forward up: range rings, the fan of beams, and a dot where a beam hits.

FREE, BEAM = style.SKY + "38", style.SKY + "60"


def reach_of(beams: Beams) -> float:
    """Return the range (m) at the picture's rim: the sensor's own, unless that is no useful number."""
    if math.isfinite(beams.most) and 0 < beams.most < 1000:
        return beams.most
    seen = beams.ranges[beams.sees]
    return max(1.2 * float(seen.max()), 0.1) if len(seen) else 1.0


def draw_rings(axes: Axes, reach: float, whole: bool) -> None:
    """Draw range rings with their metres, and rays with their angles, over half a circle or a whole one."""
    side = math.pi if whole else math.pi / 2
    arc = np.linspace(-side, side, 181)
    step = nice_step(reach)
    for ring in [*np.arange(step, reach - 0.3 * step, step), reach]:
        rim = ring == reach
        colour = style.INK if rim else style.EDGE
        beside = np.where(np.abs(arc) * ring < 0.045 * reach, np.nan, arc)  # room for the metres
        axes.plot(*_polar(beside, np.full(len(arc), ring)), color=colour, linewidth=0.8, zorder=2)
        _label_range(axes, ring)
    for degrees in range(-180, 180, 30) if whole else range(-90, 91, 30):
        turn = math.radians(degrees)
        if degrees:
            axes.plot(*_polar(turn, np.array([0.0, reach])), color=style.LINE, linewidth=0.8, zorder=1)
            _label_angle(axes, turn, reach)


def draw_beams(axes: Axes, beams: Beams, reach: float) -> None:
    """Draw the space that the beams found free, a dot where one hit, and a ring around the nearest."""
    from matplotlib.collections import LineCollection

    nearest = beams.nearest()
    ends = np.where(beams.sees, np.minimum(beams.ranges, reach), reach)
    xs, ys = _polar(beams.angles, ends)
    axes.fill(np.append(xs, 0.0), np.append(ys, 0.0), color=FREE, linewidth=0, zorder=1.5)
    rays = [((0.04 * x, 0.04 * y), (x, y)) for x, y in zip(xs, ys, strict=True)]
    axes.add_collection(LineCollection(rays, colors=BEAM, linewidths=0.5, zorder=1.6), autolim=False)
    if nearest is None:
        return
    dots: dict[str, Any] = {"marker": "o", "markersize": 3.4, "markeredgewidth": 0, "linestyle": "none"}
    axes.plot(xs[beams.sees], ys[beams.sees], color=style.VERMILLION, zorder=6, **dots)
    ring: dict[str, Any] = {
        "marker": "o",
        "markersize": 10,
        "markerfacecolor": "none",
        "markeredgewidth": 1.2,
    }
    axes.plot(xs[nearest], ys[nearest], markeredgecolor=style.INK, zorder=7, **ring)


def nice_step(reach: float) -> float:
    """Return a distance between rings: 1, 2 or 5 times a power of ten, for three to five of them."""
    power = 10.0 ** math.floor(math.log10(reach / 5.5))
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= reach / 5.5)


def _polar(angles: Any, ranges: Any) -> tuple[Any, Any]:
    """Places in the picture: forward is up, so left (a positive angle) is left."""
    return -np.sin(angles) * ranges, np.cos(angles) * ranges


def _label_range(axes: Axes, ring: float) -> None:
    look: dict[str, Any] = {"fontsize": 7.5, "color": style.INK, "ha": "center", "va": "center"}
    axes.text(*_polar(0.0, ring), f"{ring:g} m", zorder=4, **look)


def _label_angle(axes: Axes, turn: float, reach: float) -> None:
    x, y = _polar(turn, reach * 1.03)
    side = "right" if x < -0.1 * reach else "left" if x > 0.1 * reach else "center"
    text = f"{math.degrees(turn):+.0f}°\n{turn:+.2f} rad".replace("-", "−")
    look: dict[str, Any] = {"fontsize": 7.5, "color": style.INK, "ha": side, "va": "center"}
    axes.text(x, y, text, linespacing=1.25, **look)


# -- beams --------------------------------------------------------------------------------------------------------
# The beams of a laser scan: their angles, and which of them see something.

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
