"""What pictures of the world share: the turtle and the obstacles seen from above, and small drawings as SVG."""

from __future__ import annotations

import base64
import html
import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from . import style
from .recording import Obstacle
from .words import number

if TYPE_CHECKING:
    import numpy as np
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
    import numpy as np

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

    colours: dict[str, Any] = {"facecolor": style.ORANGE + "66", "edgecolor": style.DARK_ORANGE}
    for each in obstacles:
        look = {**colours, "angle": math.degrees(each.angle), "linewidth": 1.0, "zorder": 2}
        if each.shape == "box":
            corner = (each.x - each.width / 2, each.y - each.height / 2)
            axes.add_artist(Rectangle(corner, each.width, each.height, rotation_point="center", **look))
        else:
            axes.add_artist(Ellipse((each.x, each.y), each.width, each.height, **look))


# -- svg ------------------------------------------------------------------------------------------------------------
# Small drawings as SVG: the same on every machine, and seen in static HTML and on GitHub, without a kernel or a network.

FONT = "system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif"
NARROW, WIDE = "ijltfrI.,:;|!'()[]/ ", "mwMW@%"


def text_width(text: str, size: float) -> float:
    """About how many pixels a text of this size is wide, a little more rather than less."""
    return size * sum(0.36 if each in NARROW else 0.92 if each in WIDE else 0.61 for each in text)


def text(x: float, y: float, words: str, size: float = 12, anchor: str = "middle", fill: str = style.INK) -> str:
    """Words whose baseline is at `y`, and whose middle (or "start" or "end") is at `x`."""
    look = f'font-size="{size:g}" text-anchor="{anchor}" fill="{fill}"'
    return f'<text x="{number(x, 1)}" y="{number(y, 1)}" {look}>{html.escape(words)}</text>'


def document(width: float, height: float, title: str, description: str, parts: list[str]) -> str:
    """Return a whole drawing; its title and description are read out where it cannot be seen."""
    size = f'width="{width:g}" height="{height:g}" viewBox="0 0 {width:g} {height:g}"'
    head = f"<title>{html.escape(title)}</title><desc>{html.escape(description)}</desc>"
    body = "\n".join(parts)
    frame = f'<svg xmlns="http://www.w3.org/2000/svg" role="img" {size} style="max-width: 100%" font-family="{FONT}">'
    return f"{frame}\n{head}\n{body}\n</svg>"


def image(drawing: str, alternative: str) -> str:
    """Return a drawing as an element of HTML with its alternative text; Jupyter's filter lets it pass."""
    data = base64.b64encode(drawing.encode()).decode()
    return f'<img alt="{html.escape(alternative)}" src="data:image/svg+xml;base64,{data}">'


def turtle(x: float, y: float, theta: float, length: float) -> str:
    """The turtle from above: its middle at (x, y) pixels, looking along `theta` (radians, to the left)."""

    def oval(shape: tuple[float, ...], fill: str, side: int = 1) -> str:
        across, up, width, height, turn = shape
        place = f"translate({across:g} {side * up:g}) rotate({side * turn:g})"
        return f'<ellipse rx="{width / 2:g}" ry="{height / 2:g}" transform="{place}" fill="{fill}"/>'

    tail = " ".join(f"{a:g},{b:g}" for a, b in TAIL)
    parts = [f'<polygon points="{tail}" fill="{SKIN}"/>']
    parts += [oval(leg, SKIN, side) for leg in LEGS for side in (1, -1)]
    parts.append(oval(HEAD, SKIN))
    parts += [
        f'<circle cx="{EYES[0]:g}" cy="{side * EYES[1]:g}" r="{EYES[2]:g}" fill="{OUTLINE}" stroke="none"/>'
        for side in (1, -1)
    ]
    parts += [oval(BODY, RIM), oval(BACK, SHELL)]
    place = f"translate({number(x, 1)} {number(y, 1)}) rotate({number(-math.degrees(theta), 1)}) scale({length:g})"
    return f'<g transform="{place}" stroke="{OUTLINE}" stroke-width="0.015">{"".join(parts)}</g>'
