"""How everything is drawn: the one look, `Picture`, the turtle and the obstacles seen from above, and small drawings as SVG.

The look is quiet, readable on a light and on a dark page, and told apart by all eyes. Colours are those of Okabe and Ito
(https://jfly.uni-koeln.de/color/). A picture has no ground of its own: its text and lines are as far from white as from a dark
page, so that one file suits both themes. Matplotlib is imported with the first picture, not before, and `pyplot` never: its
list of open figures is shared with the learner's own plots.
"""

from __future__ import annotations

import base64
import html
import inspect
import io
import logging
import math
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from ..ros.sim.defer_sigint import defer_sigint
from ..turtlesim.obstacles import Obstacle
from .words import number

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


BLUE, SKY, GREEN, ORANGE = "#1A80C4", "#56B4E9", "#009E73", "#E69F00"
VERMILLION, PURPLE, YELLOW = "#D55E00", "#CC79A7", "#F0E442"

INK = "#767b82"
"""Text and outlines: 4.3 : 1 on white, 4.4 : 1 on the dark page of JupyterLab; no grey does better on both."""
DARK_ORANGE, DARK_GREEN = "#b57b00", "#00785a"
"""The edges of what is filled with ORANGE or GREEN."""
LINE = "#80808033"
"""Grid lines and quiet areas."""
EDGE = "#80808066"
"""The edge of a picture, and lines that divide it."""

DPI = 100
"""Pixels an inch at which a picture is shown; it is drawn with twice as many (see `SHARPNESS`)."""

SETTINGS: Any = {
    "font.family": "sans-serif",
    # The one font that comes with matplotlib, so that it is there on every machine.
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9.0,
    "text.color": INK,
    "axes.edgecolor": EDGE,
    "axes.facecolor": "none",
    "axes.labelcolor": INK,
    "axes.labelsize": 9.0,
    "axes.linewidth": 0.8,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.unicode_minus": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.formatter.useoffset": False,
    "grid.color": LINE,
    "grid.linewidth": 0.7,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "xtick.major.size": 0.0,
    "ytick.major.size": 0.0,
    "lines.linewidth": 1.6,
    "lines.solid_capstyle": "round",
    "lines.solid_joinstyle": "round",
    "path.simplify": True,
    "text.usetex": False,
    "text.parse_math": False,
}


@contextmanager
def applied() -> Iterator[None]:
    """Within this block, matplotlib draws in our style; the learner's own settings come back afterwards."""
    with _matplotlib().rc_context(SETTINGS):
        yield


@cache
def _matplotlib() -> Any:
    """The whole of matplotlib that pictures need, imported in one go that nothing interrupts."""
    # When matplotlib starts for the first time ever, it lists the machine's fonts, and says so if that takes
    # long: a remark that has no place below a learner's cell.
    logging.getLogger("matplotlib.font_manager").setLevel(logging.ERROR)
    cleandoc = inspect.cleandoc
    with defer_sigint():
        # matplotlib reads 7,600 docstrings of its own as it starts, most of them often: 13 % of its import
        inspect.cleandoc = cache(cleandoc)
        try:
            import matplotlib.backends.backend_agg
            import matplotlib.figure  # which imports all the rest
        finally:
            inspect.cleandoc = cleandoc
    return matplotlib


def card(width: float, height: float) -> Figure:
    """An empty figure (inches): a frame with round corners on a transparent ground."""
    from matplotlib.figure import Figure
    from matplotlib.patches import FancyBboxPatch

    figure = Figure(figsize=(width, height), dpi=DPI, facecolor="none")
    edge = 2.0 / DPI
    look: dict[str, Any] = {"facecolor": "none", "edgecolor": EDGE, "linewidth": 0.8, "zorder": -10}
    sheet = FancyBboxPatch((edge, edge), width - 2 * edge, height - 2 * edge, "round,pad=0,rounding_size=0.09", **look)
    sheet.set_transform(figure.dpi_scale_trans)
    figure.add_artist(sheet)
    return figure


def heading(figure: Figure, title: str, subtitle: str) -> None:
    """Title and, beneath it, the main figures, in the card's upper left corner."""
    width, height = figure.get_size_inches()
    figure.text(0.2 / width, 1 - 0.17 / height, title, fontsize=11.5, fontweight="bold", va="top")
    minus = subtitle.replace("-", "−")
    figure.text(0.2 / width, 1 - 0.41 / height, minus, fontsize=8.8, va="top")


def axes_at(figure: Figure, left: float, bottom: float, width: float, height: float, **options: Any) -> Axes:
    """Axes at a place given in inches from the card's lower left corner."""
    full_width, full_height = figure.get_size_inches()
    place = (left / full_width, bottom / full_height, width / full_width, height / full_height)
    return figure.add_axes(place, **options)


SHARPNESS = 2
"""Pixels drawn for each pixel shown, so that a picture is sharp on a fine screen."""


@dataclass(eq=False, repr=False)
class Picture:
    """A figure and its exact text: a notebook shows the figure, print and a screen reader give the text.

    `text` is one paragraph. `figure` is a matplotlib Figure, or None where there was nothing to draw: then
    the text says what is missing and what to try. `picture.figure.savefig("path.svg")` writes it to a file.
    """

    text: str
    figure: Figure | None = None

    def __repr__(self) -> str:
        return self.text

    def _ipython_display_(self) -> None:
        """Show the figure, and below it the text, folded: JupyterLab and its static pages give a PNG no alternative text."""
        from IPython.display import display

        bundle = self._repr_mimebundle_()
        data, metadata = bundle if isinstance(bundle, tuple) else (bundle, {})
        display(data, metadata=metadata, raw=True)
        if self.figure is not None:
            words = f"<details><summary>In words</summary><p>{html.escape(self.text)}</p></details>"
            display({"text/html": words}, raw=True)

    def _repr_mimebundle_(self, **options: object) -> Any:
        """What Jupyter shows: PNG and text, and as metadata the size to show and the alternative text."""
        data: dict[str, Any] = {"text/plain": self.text}
        if self.figure is None:
            return data
        width, height = (round(inches * DPI) for inches in self.figure.get_size_inches())
        data["image/png"] = self.png()
        return data, {"image/png": {"width": width, "height": height, "alt": self.text}}

    def png(self) -> bytes:
        """The figure as the bytes of a PNG file, the same bytes whenever it is drawn.

        It has 256 colours: a flat drawing needs no more, and a page stores a quarter of the bytes.
        """
        from PIL import Image

        pixels = Image.fromarray(self.pixels())
        stream = io.BytesIO()
        pixels.quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(stream, "png")
        return stream.getvalue()

    def pixels(self) -> np.ndarray:
        """The figure as rows of pixels with red, green, blue and opacity, `SHARPNESS` of them for each pixel shown."""
        import numpy as np
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        figure = self.figure
        assert figure is not None
        figure.dpi = DPI * SHARPNESS
        try:
            with applied():
                canvas = FigureCanvasAgg(figure)
                canvas.draw()
                return np.asarray(canvas.buffer_rgba())
        finally:
            figure.dpi = DPI


SHELL, RIM, SKIN, OUTLINE = GREEN, DARK_GREEN, "#8fd0b5", "#0b4636"

# The turtle looks along +x, its length is 1, its middle (0, 0). Ellipses: x, y, width, height, degrees.
LEGS = ((0.23, 0.27, 0.30, 0.15, 55.0), (-0.25, 0.25, 0.24, 0.13, 128.0))
HEAD = (0.40, 0.0, 0.25, 0.21, 0.0)
BODY = (-0.02, 0.0, 0.70, 0.58, 0.0)
BACK = (-0.02, 0.0, 0.57, 0.45, 0.0)
TAIL = ((-0.33, 0.055), (-0.49, 0.0), (-0.33, -0.055))
EYES = (0.455, 0.058, 0.021)


def draw_turtle(axes: Axes, x: float, y: float, theta: float, length: float = 0.95) -> None:
    """Draw the turtle with its middle at (x, y), looking along `theta` (radians); units of the axes."""
    from matplotlib.collections import LineCollection
    from matplotlib.patches import Circle, Ellipse, Polygon
    from matplotlib.transforms import Affine2D

    place = Affine2D().scale(length).rotate(theta).translate(x, y) + axes.transData

    def add(patch: Any, face: str, layer: int, edge: str = OUTLINE, line: float = 0.8) -> None:
        patch.set(facecolor=face, edgecolor=edge, linewidth=line, transform=place, zorder=5 + layer / 100)
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
    # the plates of the shell: a hexagon along the back, and a line from each of its corners to the rim
    middle, width, height = BACK[0], BACK[2] / 2, BACK[3] / 2
    around = [(math.cos(math.radians(turn)), math.sin(math.radians(turn))) for turn in range(0, 360, 60)]
    inner = [(middle + 0.50 * width * across, 0.52 * height * up) for across, up in around]
    outer = [(middle + width * across, height * up) for across, up in around]
    lines = [[*inner, inner[0]], *zip(inner, outer, strict=True)]
    look: dict[str, Any] = {"colors": "#d8f3e6", "linewidths": 0.8, "capstyle": "round"}
    axes.add_collection(LineCollection(lines, transform=place, zorder=5.06, **look), autolim=False)


def _ellipse(kind: Any, shape: tuple[float, ...], side: int = 1) -> Any:
    x, y, width, height, turn = shape
    return kind((x, side * y), width, height, angle=side * turn)


def draw_obstacles(axes: Axes, obstacles: Iterable[Obstacle]) -> None:
    """Draw the obstacles where they stand."""
    from matplotlib.patches import Ellipse, Rectangle

    colours: dict[str, Any] = {"facecolor": ORANGE + "66", "edgecolor": DARK_ORANGE}
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


def sizes(**numbers: float) -> str:
    """Attributes of an element with one decimal each: `sizes(x=1, width=2.25)` is 'x="1.0" width="2.2"'."""
    return " ".join(f'{name}="{number(each, 1)}"' for name, each in numbers.items())


def text(x: float, y: float, words: str, size: float = 12, anchor: str = "middle", fill: str = INK) -> str:
    """Words whose baseline is at `y`, and whose middle (or "start" or "end") is at `x`."""
    look = f'font-size="{size:g}" text-anchor="{anchor}" fill="{fill}"'
    return f"<text {sizes(x=x, y=y)} {look}>{html.escape(words)}</text>"


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
