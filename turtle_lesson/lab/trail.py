"""The trail of a turtle on the map: pale where it is old, with arrow heads that show which way it went."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from . import style
from .track import thinned

if TYPE_CHECKING:
    from matplotlib.axes import Axes

OLD, NEW = "#a9d3ee", style.BLUE


def draw_trail(axes: Axes, poses: np.ndarray, jumps: np.ndarray) -> None:
    """Draw the trail of `poses` (fields `x`, `y` in metres), dotted where a jump leads to a pose."""
    from matplotlib.collections import LineCollection
    from matplotlib.colors import LinearSegmentedColormap

    places = np.column_stack([poses["x"], poses["y"]])
    for jump in jumps:
        axes.plot(*places[jump - 1 : jump + 1].T, color=style.GREY, linestyle=":", linewidth=1.0, zorder=3)
    chosen = thinned(poses, jumps)
    pieces = np.stack([places[chosen[:-1]], places[chosen[1:]]], axis=1)
    driven = ~np.isin(chosen[1:], jumps)
    colours = LinearSegmentedColormap.from_list("age", [OLD, NEW])(np.linspace(0.0, 1.0, len(pieces)))
    look: dict[str, Any] = {"linewidths": 2.2, "capstyle": "round", "zorder": 3}
    lines = LineCollection(list(pieces[driven]), colors=colours[driven], **look)
    axes.add_collection(lines, autolim=False)
    _draw_heads(axes, pieces[driven])
    _draw_start(axes, places)


def _draw_heads(axes: Axes, pieces: np.ndarray, size: float = 0.15) -> None:
    """Open arrow heads along the trail, evenly spaced: 1.3 m apart, or more on a long trail."""
    from matplotlib.collections import LineCollection

    ways = pieces[:, 1] - pieces[:, 0]
    lengths = np.hypot(*ways.T)
    total = float(lengths.sum())
    every = max(1.3, total / 14)
    marks = np.searchsorted(np.cumsum(lengths), np.arange(0.6 * every, total - 0.5, every))
    heads = []
    for mark in marks[lengths[marks] > 0]:
        along = ways[mark] / lengths[mark] * size
        across = 0.8 * np.array([-along[1], along[0]])
        tip = pieces[mark, 1] + along / 2
        heads.append([tip - along + across, tip, tip - along - across])
    look: dict[str, Any] = {"colors": NEW, "linewidths": 1.6, "capstyle": "round", "zorder": 3.2}
    axes.add_collection(LineCollection(heads, **look), autolim=False)


def _draw_start(axes: Axes, places: np.ndarray) -> None:
    """A ring where the trail starts, and its name on the side that the trail does not take."""
    x, y = places[0]
    away = places[np.hypot(*(places - places[0]).T) > 0.5]
    ahead = math.atan2(*(away[0] - places[0])[::-1]) if len(away) else math.pi / 2
    ring: dict[str, Any] = {"markerfacecolor": style.CARD, "markeredgecolor": NEW, "markeredgewidth": 1.6}
    axes.plot([x], [y], marker="o", markersize=6.5, zorder=3.5, **ring)
    label: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 8.5, "color": style.GREY}
    offset = (-20 * math.cos(ahead), -13 * math.sin(ahead))
    axes.annotate("start", (x, y), xytext=offset, textcoords="offset points", zorder=3.5, **label)
