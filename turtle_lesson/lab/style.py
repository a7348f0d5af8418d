"""The one look of all pictures: quiet, readable on a light and on a dark page, and told apart by all eyes.

Colours are those of Okabe and Ito (https://jfly.uni-koeln.de/color/). A picture has no ground of its own: its text
and lines are as far from white as from a dark page, so that one file suits both themes. Matplotlib is imported with the first
picture, not before, and `pyplot` never: its list of open figures is shared with the learner's own plots.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import TYPE_CHECKING, Any

from ..ros.sim.defer_sigint import defer_sigint

if TYPE_CHECKING:
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
"""Pixels an inch at which a picture is shown; it is drawn with twice as many (see picture.py)."""

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
    "savefig.bbox": None,
    "svg.hashsalt": "turtle lesson",
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
    with defer_sigint():
        import matplotlib
        import matplotlib.backends.backend_agg
        import matplotlib.collections
        import matplotlib.figure
        import matplotlib.font_manager
        import matplotlib.lines
        import matplotlib.patches
        import matplotlib.ticker
        import PIL.Image  # noqa: F401
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
