"""The dashboard as a picture that stays, for those who read a page without a kernel."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np

from .. import style
from ..path import plot_path
from ..picture import SHARPNESS, Picture
from ..recording import Recording
from ..scan import plot_scan
from ..status import plot_status

if TYPE_CHECKING:
    from matplotlib.figure import Figure

GAP = 12
"""Pixels shown between two cards."""


def dashboard_picture(recording: Recording, text: str) -> Picture:
    """Path on the left, status and scan on the right, as far as there is anything to draw."""
    path, *others = (plot(recording) for plot in (plot_path, plot_status, plot_scan))
    columns = [[_pixels(each) for each in group if each.figure is not None] for group in ([path], others)]
    columns = [column for column in columns if column]
    return Picture(text, _sheet(columns) if columns else None)


def _pixels(picture: Picture) -> np.ndarray:
    """A picture as rows of pixels with red, green, blue and opacity."""
    from PIL import Image

    return np.asarray(Image.open(io.BytesIO(picture.png())).convert("RGBA"))


def _sheet(columns: list[list[np.ndarray]]) -> Figure:
    """A figure on which the pictures of each column stand below each other, pixel for pixel."""
    from matplotlib.figure import Figure

    gap = GAP * SHARPNESS
    heights = [sum(len(each) + gap for each in column) - gap for column in columns]
    widths = [max(each.shape[1] for each in column) for column in columns]
    size = np.array([sum(widths) + gap * (len(columns) - 1), max(heights)]) / (style.DPI * SHARPNESS)
    figure = Figure(figsize=tuple(size), dpi=style.DPI, facecolor="none")
    left = 0
    for column, width in zip(columns, widths, strict=True):
        top = max(heights)
        for each in column:
            figure.figimage(each, left, top - len(each), origin="upper")
            top -= len(each) + gap
        left += width + gap
    return figure
