"""The dashboard as a picture that stays, for readers of a page without a kernel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import style
from ..path import plot_path
from ..picture import SHARPNESS, Picture
from ..recording import Recording
from ..status import plot_status

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .goals import Goal

GAP = 12
"""Pixels shown between two cards."""


def dashboard_picture(recording: Recording, text: str, goal: Goal | None) -> Picture:
    """Path, with the newest goal, and status side by side, as far as there is anything to draw."""
    place = None if goal is None else (goal.x, goal.y, goal.theta)
    cards = [plot_path(recording, goal=place), plot_status(recording)]
    drawn = [card.pixels() for card in cards if card.figure is not None]
    return Picture(text, _sheet(drawn) if drawn else None)


def _sheet(cards: list[np.ndarray]) -> Figure:
    """A figure on which pictures (rows of pixels) stand side by side, pixel for pixel, their tops in line."""
    from matplotlib.figure import Figure

    gap = GAP * SHARPNESS
    width = sum(card.shape[1] + gap for card in cards) - gap
    height = max(len(card) for card in cards)
    figure = Figure(
        figsize=(width / style.DPI / SHARPNESS, height / style.DPI / SHARPNESS), dpi=style.DPI, facecolor="none"
    )
    left = 0
    for card in cards:
        figure.figimage(card, left, height - len(card), origin="upper")
        left += card.shape[1] + gap
    return figure
