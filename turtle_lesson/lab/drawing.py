"""What pictures of the world share: the turtle, seen from above, and the obstacles."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from . import style
from .recording import Obstacle

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHELL, RIM, SKIN, OUTLINE = style.GREEN, style.DARK_GREEN, "#8fd0b5", "#0b4636"

# The turtle looks along +x, its length is 1, its middle (0, 0). Ellipses: x, y, width, height, degrees.
LEGS = ((0.23, 0.27, 0.30, 0.15, 55.0), (-0.25, 0.25, 0.24, 0.13, 128.0))
HEAD = (0.40, 0.0, 0.25, 0.21, 0.0)
BODY = (-0.02, 0.0, 0.70, 0.58, 0.0)
BACK = (-0.02, 0.0, 0.57, 0.45, 0.0)
TAIL = ((-0.33, 0.055), (-0.49, 0.0), (-0.33, -0.055))
EYES = (0.455, 0.058, 0.021)


def draw_turtle(axes: Axes, x: float, y: float, theta: float, length: float = 0.95, zorder: float = 5.0) -> None:
    """Draw the turtle with its middle at (x, y), looking along `theta` (radians); units of the axes."""
    from matplotlib.patches import Circle, Ellipse, Polygon
    from matplotlib.transforms import Affine2D

    place = Affine2D().scale(length).rotate(theta).translate(x, y) + axes.transData

    def add(patch: Any, face: str, layer: int, edge: str = OUTLINE, line: float = 0.8) -> None:
        patch.set(facecolor=face, edgecolor=edge, linewidth=line, transform=place, zorder=zorder + layer / 100)
        axes.add_artist(patch)

    add(Polygon(TAIL, closed=True), SKIN, 0)
    for leg in LEGS:
        for side in (1, -1):
            add(_ellipse(Ellipse, leg, side), SKIN, 1)
    add(_ellipse(Ellipse, HEAD), SKIN, 2)
    for side in (1, -1):
        add(Circle((EYES[0], side * EYES[1]), EYES[2]), OUTLINE, 3, line=0.0)
    add(_ellipse(Ellipse, BODY), RIM, 4)
    add(_ellipse(Ellipse, BACK), SHELL, 5, edge="none")
    _draw_scutes(axes, place, zorder + 0.06)


def turtle_points(x: float, y: float, length: float = 0.95) -> np.ndarray:
    """Return points (n by 2) that a turtle covers, however it is turned."""
    turns = np.linspace(0, math.tau, 24, endpoint=False)
    rings = [part * length / 2 * np.column_stack([np.cos(turns), np.sin(turns)]) for part in (0.4, 0.7, 1.0)]
    return np.array([x, y]) + np.concatenate(rings)


def _ellipse(kind: Any, shape: tuple[float, ...], side: int = 1) -> Any:
    x, y, width, height, turn = shape
    return kind((x, side * y), width, height, angle=side * turn)


def _draw_scutes(axes: Axes, place: Any, zorder: float) -> None:
    """The plates of the shell: a hexagon along the back, and a line from each of its corners to the rim."""
    from matplotlib.collections import LineCollection

    middle, width, height = BACK[0], BACK[2] / 2, BACK[3] / 2
    around = [(math.cos(math.radians(turn)), math.sin(math.radians(turn))) for turn in range(0, 360, 60)]
    inner = [(middle + 0.50 * width * across, 0.52 * height * up) for across, up in around]
    outer = [(middle + width * across, height * up) for across, up in around]
    lines = [[*inner, inner[0]], *zip(inner, outer, strict=True)]
    axes.add_collection(
        LineCollection(lines, colors="#d8f3e6", linewidths=0.8, transform=place, zorder=zorder, capstyle="round"),
        autolim=False,
    )


def draw_obstacles(axes: Axes, obstacles: Iterable[Obstacle]) -> None:
    """Draw the obstacles where they stand."""
    from matplotlib.patches import Ellipse, Rectangle

    look: dict[str, Any] = {
        "facecolor": style.ORANGE + "66",
        "edgecolor": style.DARK_ORANGE,
        "linewidth": 1.0,
        "zorder": 2,
    }
    for each in obstacles:
        if each.shape == "box":
            corner = (each.x - each.width / 2, each.y - each.height / 2)
            turn = math.degrees(each.angle)
            axes.add_artist(Rectangle(corner, each.width, each.height, angle=turn, rotation_point="center", **look))
        else:
            axes.add_artist(Ellipse((each.x, each.y), each.width, each.height, angle=math.degrees(each.angle), **look))
