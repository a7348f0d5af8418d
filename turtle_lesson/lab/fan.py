"""A scan drawn from above, forward up: range rings, the fan of beams, and a dot where a beam hits."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from . import style
from .beams import Beams

if TYPE_CHECKING:
    from matplotlib.axes import Axes

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
