"""What the obstacle detector sees: the newest laser scan, from above, forward up."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import style
from .drawing import draw_turtle
from .picture import Picture
from .recording import SCAN_TOPIC, Recording
from .words import angle, count, number, rate

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SIDE = math.radians(30)
"""Up to this angle to either side, a reading counts as ahead."""


@dataclass(frozen=True)
class Beams:
    """A scan's beams: their angles (rad, positive to the left), ranges (m), and which of them see something.

    As sensor_msgs/msg/LaserScan says, a range below its minimum or above its maximum, or none at all, is to
    be discarded; one at the maximum itself is what a detector that sees nothing reports.
    """

    angles: np.ndarray
    ranges: np.ndarray
    sees: np.ndarray
    least: float
    most: float
    asked: int


def read_beams(scan: Any) -> Beams:
    """Return the beams of a sensor_msgs/msg/LaserScan."""
    ranges = np.asarray(scan.ranges, float)
    angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
    sees = np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges < scan.range_max - 1e-6)
    span = scan.angle_max - scan.angle_min
    asked = math.floor(span / scan.angle_increment + 1e-3) + 1 if scan.angle_increment else 1
    return Beams(angles, ranges, sees, scan.range_min, scan.range_max, asked)


def plot_scan(recording: Recording) -> Picture:
    """Return the newest scan on /obstacles as a Picture. Without a scan, the Picture says why."""
    if recording.last_scan is None:
        return Picture(f"No scan yet. {recording.why_silent(SCAN_TOPIC)}")
    beams = read_beams(recording.last_scan)
    stamps = recording.scans.array()["stamp"]
    second = float(recording.seconds(stamps[-1]))
    with style.applied():
        figure = _draw(beams, second)
    return Picture(_describe(beams, second, stamps), figure)


# -- in words ----------------------------------------------------------------------------------------------------


def _describe(beams: Beams, second: float, stamps: np.ndarray) -> str:
    sentences = [
        f"Scan on {SCAN_TOPIC} at {number(second)} s of robot time: {_layout(beams)}.",
        _counted(beams),
        _agreement(beams),
        _nearest(beams),
        f"So far: {rate(stamps)}.",
    ]
    return " ".join(filter(None, sentences))


def _layout(beams: Beams) -> str:
    amount = count(len(beams.ranges), "beam")
    if not len(beams.ranges):
        return amount
    ends = f"from {angle(beams.angles[0])} to {angle(beams.angles[-1])}, positive to the left"
    return f"{amount} {ends}, for ranges from {number(beams.least)} m to {number(beams.most)} m"


def _counted(beams: Beams) -> str:
    seen, amount = int(beams.sees.sum()), len(beams.ranges)
    if amount and seen == amount:
        return "All of them see something."
    return (
        f"{count(seen, 'beam').capitalize()} of {amount} {'sees' if seen < 2 else 'see'} something."
        if amount
        else ""
    )


def _agreement(beams: Beams) -> str:
    if len(beams.ranges) == beams.asked:
        return ""
    return f"But its angle_min, angle_max and angle_increment ask for {beams.asked} readings: the message contradicts itself."


def _nearest(beams: Beams) -> str:
    if not beams.sees.any():
        return ""
    parts = [
        f"{name} {number(beams.ranges[best])} m at {angle(beams.angles[best])}"
        for name, best in _sectors(beams)
    ]
    best = nearest_beam(beams)
    return f"The nearest is {number(beams.ranges[best])} m away at {angle(beams.angles[best])}. Nearest by side: {'; '.join(parts)}."


def nearest_beam(beams: Beams, among: np.ndarray | None = None) -> int:
    """Return the index of the beam that sees the nearest thing; of several, the one closest to straight ahead."""
    seeing = np.flatnonzero(beams.sees if among is None else beams.sees & among)
    return int(seeing[np.lexsort((np.abs(beams.angles[seeing]), beams.ranges[seeing].round(6)))[0]])


def _sectors(beams: Beams) -> list[tuple[str, int]]:
    """The nearest beam to the right, ahead, to the left and behind, where any beam sees something there."""
    turn = np.remainder(beams.angles + math.pi, math.tau) - math.pi
    behind = np.abs(turn) > math.radians(90.5)
    sectors = {
        "right": (turn < -SIDE) & ~behind,
        "ahead": np.abs(turn) <= SIDE,
        "left": (turn > SIDE) & ~behind,
        "behind": behind,
    }
    return [
        (name, nearest_beam(beams, among)) for name, among in sectors.items() if (beams.sees & among).any()
    ]


# -- as a picture ------------------------------------------------------------------------------------------------


def _draw(beams: Beams, second: float) -> Any:
    reach = _reach(beams)
    whole = bool(len(beams.angles)) and float(np.abs(beams.angles).max()) > math.radians(100)
    low, high, side = (-1.1 if whole else -0.1), 1.1, 1.25
    width = 5.9
    height = width * (high - low) / (2 * side)
    figure = style.card(6.4, height + 0.82)
    seen = int(beams.sees.sum())
    figures = f"{seen} of {len(beams.ranges)} beams see something"
    if seen:
        best = nearest_beam(beams)
        figures += (
            f", the nearest at {number(beams.ranges[best])} m, {number(math.degrees(beams.angles[best]), 0)}°"
        )
    style.heading(
        figure,
        "What the obstacle detector sees",
        f"{SCAN_TOPIC} at {number(second, 1)} s of robot time  ·  {figures}",
    )
    axes = style.axes_at(figure, 0.25, 0.12, width, height)
    axes.set(xlim=(-side * reach, side * reach), ylim=(low * reach, high * reach), aspect="equal")
    axes.axis("off")
    _draw_rings(axes, reach, math.pi if whole else math.pi / 2)
    _draw_beams(axes, beams, reach)
    draw_turtle(axes, 0.0, 0.0, math.pi / 2, length=0.075 * reach)
    return figure


def _reach(beams: Beams) -> float:
    """The range at the picture's rim: the sensor's own, unless that is no useful number."""
    seen = beams.ranges[beams.sees]
    farthest = float(seen.max()) if len(seen) else 1.0
    useful = math.isfinite(beams.most) and 0 < beams.most < 1000
    return beams.most if useful else max(1.2 * farthest, 0.1)


def _polar(angles: Any, ranges: Any) -> tuple[Any, Any]:
    """Places in the picture: forward is up, so left (a positive angle) is left."""
    return -np.sin(angles) * ranges, np.cos(angles) * ranges


def _draw_rings(axes: Axes, reach: float, side: float) -> None:
    step = _nice_step(reach)
    arc = np.linspace(-side, side, 181)
    axes.fill(*_polar(arc, np.full(181, reach)), color=style.CARD, zorder=0)
    for ring in np.append(np.arange(step, reach - 0.3 * step, step), reach):
        axes.plot(
            *_polar(arc, np.full(181, ring)),
            color=style.CARD_EDGE if ring < reach else style.GREY,
            linewidth=0.8,
            zorder=2,
        )
        _label(axes, 0.0, ring, f"{ring:g} m")
    for degrees in range(-90, 91, 30) if side < 3 else range(-180, 180, 30):
        turn = math.radians(degrees)
        axes.plot(*_polar(turn, np.array([0.0, reach])), color=style.LINE, linewidth=0.8, zorder=1)
        if degrees != 0:
            _label_angle(axes, turn, reach)


def _label(axes: Axes, turn: float, ring: float, text: str) -> None:
    box = {"boxstyle": "round,pad=0.12", "facecolor": style.CARD, "edgecolor": "none", "alpha": 0.85}
    axes.text(
        *_polar(turn, ring),
        text,
        fontsize=7.5,
        color=style.GREY,
        ha="center",
        va="center",
        bbox=box,
        zorder=4,
    )


def _label_angle(axes: Axes, turn: float, reach: float) -> None:
    x, y = _polar(turn, reach * 1.03)
    side = "right" if x < -0.1 * reach else "left" if x > 0.1 * reach else "center"
    text = f"{math.degrees(turn):+.0f}°\n{turn:+.2f} rad".replace("-", "−")
    axes.text(x, y, text, fontsize=7.5, color=style.GREY, ha=side, va="center", linespacing=1.25)


def _draw_beams(axes: Axes, beams: Beams, reach: float) -> None:
    """The space that the beams found free, a dot where one hit something, and a ring around the nearest."""
    from matplotlib.collections import LineCollection

    if not len(beams.ranges):
        return
    ends = np.where(beams.sees, np.minimum(beams.ranges, reach), reach)
    xs, ys = _polar(beams.angles, ends)
    axes.fill(np.append(xs, 0.0), np.append(ys, 0.0), color="#dceefa", linewidth=0, zorder=1.5)
    rays = np.stack([np.column_stack([0.04 * xs, 0.04 * ys]), np.column_stack([xs, ys])], axis=1)
    axes.add_collection(
        LineCollection(list(rays), colors="#bfe0f5", linewidths=0.5, zorder=1.6), autolim=False
    )
    if not beams.sees.any():
        return
    axes.plot(
        xs[beams.sees],
        ys[beams.sees],
        "o",
        markersize=3.4,
        color=style.VERMILLION,
        markeredgewidth=0,
        zorder=6,
    )
    best = nearest_beam(beams)
    axes.plot(
        xs[best],
        ys[best],
        "o",
        markersize=10,
        markerfacecolor="none",
        markeredgecolor=style.INK,
        markeredgewidth=1.2,
        zorder=7,
    )


def _nice_step(reach: float) -> float:
    """A distance between rings, from 1, 2 and 5 times a power of ten, that gives four to six of them or so."""
    power = 10.0 ** math.floor(math.log10(reach / 4))
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= reach / 5.5)
