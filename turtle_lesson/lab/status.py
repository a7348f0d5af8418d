"""What the status monitor reported: position, heading, velocity and battery over robot time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import drawing
from .drawing import Picture
from .recording import STATUS_TOPIC, Recording
from .words import angle, count, number, point, rate

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def plot_status(recording: Recording, *, since: float | None = None, until: float | None = None) -> Picture:
    """Return what came on /robot/status as a Picture. Without a message, the Picture says why.

    `since` and `until` are in seconds since the lesson's start.
    """
    rows = recording.window(recording.statuses, since, until)
    if not len(recording.statuses):
        return Picture(f"No status yet. {recording.why_silent(STATUS_TOPIC)}")
    if not len(rows):
        return Picture(f"No status in these seconds: statuses were heard from {recording.span(recording.statuses)}.")
    seconds = recording.seconds(rows["stamp"])
    with drawing.applied():
        figure = _draw(seconds, rows)
    return Picture(_describe(seconds, rows), figure)


def _describe(seconds: np.ndarray, rows: np.ndarray) -> str:
    first, last = rows[0], rows[-1]
    speeds = np.hypot(rows["vel_x"], rows["vel_y"])
    clauses = {
        f"Position from {point(first['x'], first['y'])} m to {point(last['x'], last['y'])} m": last["x"] + last["y"],
        f"heading from {angle(first['theta'])} to {angle(last['theta'])}": last["theta"],
        f"speed at most {number(speeds.max())} m/s, {number(speeds[-1])} m/s at the end "
        f"({number(last['vel_x'])} along x and {number(last['vel_y'])} along y)": speeds[-1],
        f"battery from {number(first['battery'], 1)} % to {number(last['battery'], 1)} %": last["battery"],
    }
    time = f"{number(seconds[0])} s to {number(seconds[-1])} s of robot time"
    known = "; ".join(clause for clause, value in clauses.items() if not math.isnan(value))
    return f"Status on {STATUS_TOPIC} from {time}: {rate(rows['stamp'])}. {known[:1].upper()}{known[1:]}."


def _draw(seconds: np.ndarray, rows: np.ndarray) -> Figure:
    figure = drawing.card(6.4, 5.05)
    last = rows[-1]
    place = f"{point(last['x'], last['y'])} m, {number(math.degrees(last['theta']), 0)}°"
    now = f"at {number(seconds[-1], 1)} s: {place}, battery {number(last['battery'], 1)} %"
    drawing.heading(figure, "Status of the robot", f"{count(len(rows), 'message')} on {STATUS_TOPIC}  ·  {now}")
    panels: list[Axes] = []
    for row in range(4):
        shared = panels[0] if panels else None
        panel = drawing.axes_at(figure, 0.95, 3.56 - 1.02 * row, 4.75, 0.82, sharex=shared)
        panel.tick_params(labelbottom=row == 3)
        panels.append(panel)
    panels[0].set_ylabel("position\nin m")
    _lines(panels[0], seconds, {"x": (rows["x"], drawing.BLUE), "y": (rows["y"], drawing.VERMILLION)}, least=1.0)
    _draw_heading(panels[1], seconds, rows["theta"])
    panels[2].set_ylabel("velocity\nin m/s")
    speed = np.hypot(rows["vel_x"], rows["vel_y"])
    panels[2].fill_between(seconds, 0, speed, color=drawing.LINE, linewidth=0)
    along = {"x": (rows["vel_x"], drawing.BLUE), "y": (rows["vel_y"], drawing.VERMILLION)}
    _lines(panels[2], seconds, {**along, "speed": (speed, drawing.INK)}, least=0.2)
    panels[3].set(ylabel="battery\nin %", ylim=(0, 108), yticks=[0, 50, 100], xlabel="robot time in seconds")
    panels[3].fill_between(seconds, 0, rows["battery"], color=drawing.GREEN + "30", linewidth=0)
    panels[3].plot(seconds, rows["battery"], color=drawing.GREEN, linewidth=1.8)
    begin, end = float(seconds[0]), float(seconds[-1])  # the axis is a little wider than the data, and begins at 0 if
    spare = 0.01 * (end - begin) or 0.5  # they start close to it
    panels[3].set_xlim(0.0 if 0 <= begin < 5 * spare else begin - spare, end + spare)
    figure.align_ylabels(panels)
    return figure


def _draw_heading(panel: Axes, seconds: np.ndarray, theta: np.ndarray) -> None:
    """Radians on the left, the same in degrees on the right; no line across the jump from pi to minus pi."""
    panel.set_ylabel("heading\nin rad")
    broken = np.where(np.abs(np.diff(theta, prepend=theta[:1])) > math.pi, np.nan, theta)
    panel.plot(seconds, broken, color=drawing.PURPLE, linewidth=1.8)
    panel.set_ylim(-math.pi * 1.12, math.pi * 1.12)
    panel.set_yticks([-math.pi, 0, math.pi], ["−π", "0", "π"])
    panel.set_yticks([-math.pi / 2, math.pi / 2], minor=True)
    panel.grid(which="minor")
    degrees = panel.twinx()
    degrees.set_ylim(panel.get_ylim())
    quarters = [quarter * math.pi / 2 for quarter in range(-2, 3)]
    degrees.set_yticks(quarters, ["−180°", "−90°", "0°", "90°", "180°"], fontsize=7.5)
    degrees.grid(False)
    panel.tick_params(which="minor", length=0)


def _lines(panel: Axes, seconds: np.ndarray, lines: dict[str, Any], least: float) -> None:
    """Lines with their names at their ends, in a range of at least `least`, so that noise looks like noise."""
    from matplotlib.ticker import MaxNLocator

    values = np.concatenate([values[np.isfinite(values)] for values, _ in lines.values()])
    low, high = (values.min(), values.max()) if len(values) else (0.0, 0.0)
    spare = max(least - (high - low), 0.0) / 2 + 0.12 * max(high - low, least)
    panel.set_ylim(low - spare, high + spare)
    panel.yaxis.set_major_locator(MaxNLocator(nbins=3, steps=[1, 2, 5, 10]))
    ends = spread([float(values[-1]) for values, _ in lines.values()], 0.22 * (high - low + 2 * spare))
    for (name, (values, colour)), end in zip(lines.items(), ends, strict=True):
        if name != "speed":
            panel.plot(seconds, values, color=colour, linewidth=1.8)
        label_beside(panel, name, end, 7, color=colour, fontweight="normal" if name == "speed" else "bold")


def label_beside(axes: Axes, text: str, height: float, gap: float, **look: Any) -> None:
    """Write a text to the right of the axes, at a height in the axes' units and so many points away from them."""
    place: dict[str, Any] = {"xycoords": ("axes fraction", "data"), "textcoords": "offset points"}
    axes.annotate(text, (1.0, height), xytext=(gap, 0), va="center", annotation_clip=False, **place, **look)


def spread(places: Sequence[float], least: float) -> list[float]:
    """Return places for labels, moved apart until they are `least` from each other; no number counts as 0."""
    wanted = np.nan_to_num(np.asarray(places, float), posinf=0.0, neginf=0.0)
    order = np.argsort(wanted, kind="stable")
    moved = wanted[order]
    for above in range(1, len(moved)):
        moved[above] = max(moved[above], moved[above - 1] + least)
    moved += (wanted.sum() - moved.sum()) / len(moved)
    placed = np.empty(len(moved))
    placed[order] = moved
    return placed.tolist()
