"""What the obstacle detector sees: the newest laser scan."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from . import style
from .drawing import draw_turtle
from .laser_plot import Beams, draw_beams, draw_rings, reach_of, read_beams
from .picture import Picture
from .recording import SCAN_TOPIC, Recording
from .words import angle, count, number, rate

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def plot_scan(recording: Recording) -> Picture:
    """Return the newest scan on /obstacles as a Picture. Without a scan, the Picture says why."""
    if recording.last_scan is None:
        return Picture(f"No scan yet. {recording.why_silent(SCAN_TOPIC)}")
    beams = read_beams(recording.last_scan)
    stamps = recording.scans.array()["stamp"]
    second = float(recording.seconds(stamps[-1]))
    sentences = [
        f"Scan on {SCAN_TOPIC} at {number(second)} s of robot time: {_layout(beams)}.",
        _counted(beams),
        _agreement(beams),
        _nearest(beams),
        f"So far: {rate(stamps)}.",
    ]
    with style.applied():
        figure = _draw(beams, second)
    return Picture(" ".join(filter(None, sentences)), figure)


def _layout(beams: Beams) -> str:
    amount = count(len(beams), "beam")
    if not len(beams):
        return amount
    ends = f"from {angle(beams.angles[0])} to {angle(beams.angles[-1])}, positive to the left"
    return f"{amount} {ends}, for ranges from {number(beams.least)} m to {number(beams.most)} m"


def _counted(beams: Beams) -> str:
    seen = int(beams.sees.sum())
    if not len(beams):
        return ""
    if seen == len(beams):
        return "All of them see something."
    return f"{count(seen, 'beam').capitalize()} of {len(beams)} {'sees' if seen < 2 else 'see'} something."


def _agreement(beams: Beams) -> str:
    if len(beams) == beams.asked:
        return ""
    wanted = f"angle_min, angle_max and angle_increment ask for {beams.asked} readings"
    return f"But its {wanted}: the message contradicts itself."


def _nearest(beams: Beams) -> str:
    best = beams.nearest()
    if best is None:
        return ""
    sides = [f"{side} {_reading(beams, beam)}" for side, beam in beams.nearest_by_side().items()]
    return f"The nearest is {_reading(beams, best)}. Nearest by side: {'; '.join(sides)}."


def _reading(beams: Beams, beam: int) -> str:
    return f"{number(beams.ranges[beam])} m at {angle(beams.angles[beam])}"


def _draw(beams: Beams, second: float) -> Figure:
    low, high, side = (-1.1 if beams.whole else -0.1), 1.1, 1.25
    width = 5.9
    height = width * (high - low) / (2 * side)
    figure = style.card(6.4, height + 0.82)
    style.heading(figure, "What the obstacle detector sees", _subtitle(beams, second))
    axes = style.axes_at(figure, 0.25, 0.12, width, height)
    reach = reach_of(beams)
    axes.set(xlim=(-side * reach, side * reach), ylim=(low * reach, high * reach), aspect="equal")
    axes.axis("off")
    draw_rings(axes, reach, beams.whole)
    draw_beams(axes, beams, reach)
    draw_turtle(axes, 0.0, 0.0, math.pi / 2, length=_turtle_length(beams, reach))
    return figure


def _turtle_length(beams: Beams, reach: float) -> float:
    """The turtle's length, m: as large as looks good, but it hides no hit."""
    nearest = beams.nearest()
    room = 1.3 * float(beams.ranges[nearest]) if nearest is not None else math.inf
    return max(0.02 * reach, min(0.075 * reach, room))


def _subtitle(beams: Beams, second: float) -> str:
    figures = f"{int(beams.sees.sum())} of {len(beams)} beams see something"
    best = beams.nearest()
    if best is not None:
        degrees = number(math.degrees(beams.angles[best]), 0)
        figures += f", the nearest at {number(beams.ranges[best])} m, {degrees}°"
    return f"{SCAN_TOPIC} at {number(second, 1)} s of robot time  ·  {figures}"
