"""The trail of a turtle on the map: pale where it is old, with arrow heads that show which way it went."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from . import style
from .track import WORLD, thinned

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BANDS = 12
"""The trail is drawn in so many parts, the older the paler."""

LABEL = (0.45, 0.2)
"""Half the width and half the height of the word "start", m."""


def draw_trail(axes: Axes, poses: np.ndarray, jumps: np.ndarray, taken: np.ndarray) -> None:
    """Draw the trail of `poses` (fields `x`, `y` in metres), dotted where a jump leads to a pose.

    `taken` holds points (n by 2, m) that its label must not cover, such as those of the turtle.
    """
    places = np.column_stack([poses["x"], poses["y"]])
    for jump in jumps:
        axes.plot(*places[jump - 1 : jump + 1].T, color=style.INK, linestyle=":", linewidth=1.0, zorder=3)
    chosen = thinned(poses, jumps)
    look: dict[str, Any] = {"color": style.BLUE, "linewidth": 2.2, "solid_capstyle": "butt", "zorder": 3}
    for band, part in enumerate(np.array_split(np.arange(len(chosen) - 1), BANDS)):
        if len(part):
            rows = chosen[part[0] : part[-1] + 2]
            path = np.insert(places[rows], np.flatnonzero(np.isin(rows[1:], jumps)) + 1, np.nan, axis=0)
            axes.plot(*path.T, alpha=0.3 + 0.7 * band / (BANDS - 1), **look)
    pieces = np.stack([places[chosen[:-1]], places[chosen[1:]]], axis=1)
    _draw_heads(axes, pieces[~np.isin(chosen[1:], jumps)])
    _draw_start(axes, places, np.concatenate([places[chosen], taken]))


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
    look: dict[str, Any] = {"colors": style.BLUE, "linewidths": 1.6, "capstyle": "round", "zorder": 3.2}
    axes.add_collection(LineCollection(heads, **look), autolim=False)


def _draw_start(axes: Axes, places: np.ndarray, taken: np.ndarray) -> None:
    """A ring where the trail starts, and its name beside it, where it covers as little as possible."""
    x, y = places[0]
    away = places[np.hypot(*(places - places[0]).T) > 0.5]
    behind = math.atan2(*(places[0] - away[0])[::-1]) if len(away) else -math.pi / 2
    ring: dict[str, Any] = {"markerfacecolor": "#d3e6f3", "markeredgecolor": style.BLUE, "markeredgewidth": 1.6}
    axes.plot([x], [y], marker="o", markersize=6.5, zorder=3.5, **ring)
    label: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 8.5, "color": style.INK}
    axes.text(*_free_place(x, y, behind, taken), "start", zorder=3.5, **label)


def _free_place(x: float, y: float, wanted: float, taken: np.ndarray) -> tuple[float, float]:
    """A place for the label around (x, y): where it covers least, near, and in the wanted direction (rad)."""
    turns = [wanted + sign * math.pi / 4 * step for step in range(5) for sign in (1, -1)]
    ways = [(far * math.cos(turn), far * math.sin(turn)) for far in (1.0, 1.6, 2.2, 3.0) for turn in turns]
    places = np.array([(x + 0.68 * across, y + 0.45 * up) for across, up in ways])
    within = np.clip(places, np.array(LABEL) + 0.05, WORLD - 0.05 - np.array(LABEL))
    covered = [(np.abs(taken - place) < LABEL).all(axis=1).sum() for place in within]
    across, up = within[np.argmin(covered)]
    return float(across), float(up)
