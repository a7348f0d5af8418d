"""Goals that a picture is to mark. No topic tells of a request to a service, so the caller names them."""

from __future__ import annotations

import math
from numbers import Real
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TOLERANCE = 0.2
"""Metres within which a goal counts as reached: the radius of the ring around it."""


class Goal(NamedTuple):
    """A place in metres, and the heading in radians to end with, if any."""

    x: float
    y: float
    theta: float | None = None


def read_goals(given: Any) -> list[Goal]:
    """Return the goals that were given as None, (x, y), (x, y, theta), or a list of these."""
    if given is None:
        return []
    try:
        items = list(given)
    except TypeError:
        items = [given]
    one = items and all(isinstance(item, Real) for item in items)
    return [_read_goal(item) for item in ([items] if one else items)]


def _read_goal(item: Any) -> Goal:
    try:
        numbers = [float(value) for value in item]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) not in (2, 3) or not all(map(math.isfinite, numbers)):
        raise ValueError(
            "a goal is (x, y) in metres, or (x, y, theta) with the heading in radians, or a list of these; "
            f"got {item!r}; try goal=(8.0, 8.0, 1.57)"
        )
    return Goal(*numbers)


def goal_points(goal: Goal) -> np.ndarray:
    """Return points (n by 2, m) that a goal's flag and ring cover."""
    flag = [(right, up) for right in (0.0, 0.15, 0.3) for up in np.arange(-0.4, 0.95, 0.1)]
    return np.array([goal.x, goal.y]) + np.array([*flag, (-0.2, 0.0), (0.4, 0.0)])


def draw_goal(axes: Axes, goal: Goal) -> None:
    """Draw a flag, the ring within which the goal counts as reached, and on it a pointer for the heading."""
    from matplotlib.patches import Circle, Polygon

    x, y, colour = goal.x, goal.y, style.VERMILLION
    axes.add_artist(Circle((x, y), TOLERANCE, facecolor=colour + "22", edgecolor=colour, linewidth=1.2, zorder=4))
    axes.plot([x, x], [y, y + 0.85], color=style.INK, linewidth=1.3, zorder=7, solid_capstyle="round")
    flag = [(x, y + 0.87), (x + 0.44, y + 0.71), (x, y + 0.55)]
    axes.add_artist(Polygon(flag, closed=True, facecolor=colour, edgecolor="none", zorder=7))
    if goal.theta is not None:
        corners = ((TOLERANCE + 0.24, 0.0), (TOLERANCE + 0.04, 0.75), (TOLERANCE + 0.04, -0.75))
        pointer = [(x + r * math.cos(goal.theta + turn), y + r * math.sin(goal.theta + turn)) for r, turn in corners]
        axes.add_artist(Polygon(pointer, closed=True, facecolor=colour, edgecolor="none", zorder=4.1))
