"""A live plot where it cannot live: the picture of one moment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .. import style
from ..picture import Picture
from ..status import spread
from ..words import number

Window = tuple[str, np.ndarray, np.ndarray]
"""A curve's name, its times (s) and its numbers."""

COLOURS = (style.BLUE, style.VERMILLION, style.GREEN, style.PURPLE, style.ORANGE, style.SKY, "#8a6fd0", style.INK)
DASHES: Sequence[Any] = ("-", (0, (6, 2)), (0, (2, 1.5)), (0, (8, 2, 2, 2)), "-", (0, (6, 2)), (0, (2, 1.5)), "-")
"""Beside the colours, so that curves are told apart without them; the same as in the browser (live_plot.js)."""

LONGEST_NAME = 14
"""Characters of a curve's name that fit beside it; the end of a longer one, which tells most, is kept."""


def draw(text: str, windows: list[Window], now: float, seconds: float) -> Picture:
    """The curves over the last `seconds` before `now`; a text alone where there is nothing to draw."""
    if not any(np.isfinite(values).any() for _, _, values in windows):
        return Picture(text)
    with style.applied():
        figure = style.card(6.4, 3.4)
        begin = max(0.0, now - seconds) if now >= 0 else now - seconds
        style.heading(figure, "Live plot", f"{number(begin, 1)} s to {number(now, 1)} s of robot time")
        axes = style.axes_at(figure, 0.75, 0.5, 3.95, 2.2)
        axes.set_xlabel("robot time in seconds")
        for index, (_, times, values) in enumerate(windows):
            axes.plot(times, values, color=COLOURS[index], linestyle=DASHES[index], linewidth=1.8)
        axes.set_xlim(begin, max(now, begin + 1e-6))
        _set_heights(axes, windows)
        _label(axes, windows)
    return Picture(text, figure)


def _set_heights(axes: Any, windows: list[Window]) -> None:
    every = np.concatenate([values[np.isfinite(values)] for _, _, values in windows])
    low, high = every.min(), every.max()
    spare = 0.08 * (high - low) or max(0.5, 0.05 * abs(high))
    axes.set_ylim(low - spare, high + spare)


def _label(axes: Any, windows: list[Window]) -> None:
    """At the right end of each curve its name and its last number."""
    shown = [(index, *window) for index, window in enumerate(windows) if len(window[1])]
    low, high = axes.get_ylim()
    places = spread([float(values[-1]) for *_, values in shown], 0.085 * (high - low))
    for (index, name, _, values), place in zip(shown, places, strict=True):
        short = name if len(name) <= LONGEST_NAME else f"…{name[1 - LONGEST_NAME :]}"
        label = f"{short}  {number(float(values[-1]))}"
        axes.annotate(
            label,
            (1.0, place),
            xycoords=("axes fraction", "data"),
            xytext=(8, 0),
            textcoords="offset points",
            color=COLOURS[index],
            fontsize=8.5,
            fontweight="bold",
            va="center",
            annotation_clip=False,
        )
