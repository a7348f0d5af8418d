"""Two pictures: what the status monitor reported over robot time, and the newest laser scan.

The status is position, heading, velocity and battery; the scan is its beams, what they say, and the fan seen from above,
forward up.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import drawing
from .drawing import Picture, draw_turtle
from .recording import SCAN_TOPIC, STATUS_TOPIC, Recording
from .words import angle, count, number, point, rate

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def plot_status(recording: Recording) -> Picture:
    """Return what came on /robot/status as a Picture. Without a message, the Picture says why."""
    rows = recording.statuses.array()
    if not len(rows):
        return Picture(f"No status yet. {recording.why_silent(STATUS_TOPIC)}")
    seconds = recording.seconds(rows["stamp"])
    with drawing.applied():
        figure = _draw_status(seconds, rows)
    return Picture(_describe_status(seconds, rows), figure)


def _describe_status(seconds: np.ndarray, rows: np.ndarray) -> str:
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


def _draw_status(seconds: np.ndarray, rows: np.ndarray) -> Figure:
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
    # the axis is a little wider than the data, and begins at 0 if they start close to it
    begin, end = float(seconds[0]), float(seconds[-1])
    spare = 0.01 * (end - begin) or 0.5
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


# -- the newest laser scan ---------------------------------------------------------------------------------------------


AHEAD = math.radians(30)
"""Up to this angle to either side, a reading counts as ahead."""

BESIDE = math.radians(90.5)
"""From there to this angle it counts as beside, and beyond it as behind."""


@dataclass(frozen=True)
class Beams:
    """Angles in rad (0 is ahead, positive to the left), ranges in m, and which beams see something.

    `least` and `most` bound the ranges that the sensor can tell; `asked` is the number of readings that its
    angles ask for.
    """

    angles: np.ndarray
    ranges: np.ndarray
    sees: np.ndarray
    least: float
    most: float
    asked: int

    def __len__(self) -> int:
        return len(self.ranges)

    @property
    def whole(self) -> bool:
        """Whether the sensor also looks back."""
        return bool((np.abs(self.angles) > math.radians(100)).any())

    def nearest(self, among: np.ndarray | None = None) -> int | None:
        """The index of the beam with the nearest thing, of several the one closest to ahead; or None."""
        seeing = np.flatnonzero(self.sees if among is None else self.sees & among)
        if not len(seeing):
            return None
        order = np.lexsort((np.abs(self.angles[seeing]), self.ranges[seeing].round(6)))
        return int(seeing[order[0]])

    def nearest_by_side(self) -> dict[str, int]:
        """The nearest beam to the right, ahead, to the left and behind, where any sees something there."""
        turn = np.remainder(self.angles + math.pi, math.tau) - math.pi
        sides = {
            "right": (turn < -AHEAD) & (turn >= -BESIDE),
            "ahead": np.abs(turn) <= AHEAD,
            "left": (turn > AHEAD) & (turn <= BESIDE),
            "behind": np.abs(turn) > BESIDE,
        }
        return {side: beam for side, among in sides.items() if (beam := self.nearest(among)) is not None}


def read_beams(scan: Any) -> Beams:
    """Return the beams of a sensor_msgs/msg/LaserScan.

    As that message's definition says, a range below range_min or above range_max, or no number at all, is to
    be discarded. A range of range_max itself is what a detector reports that sees nothing.
    """
    ranges = np.asarray(scan.ranges, float)
    angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
    sees = np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges < scan.range_max - 1e-6)
    steps = (scan.angle_max - scan.angle_min) / scan.angle_increment if scan.angle_increment else math.nan
    # float32 steps may fall a little short
    asked = max(math.floor(steps + 1e-3) + 1, 0) if math.isfinite(steps) else 1
    return Beams(angles, ranges, sees, scan.range_min, scan.range_max, asked)


def plot_scan(recording: Recording) -> Picture:
    """Return the newest scan on /obstacles as a Picture. Without a scan, the Picture says why."""
    if recording.last_scan is None:
        return Picture(f"No scan yet. {recording.why_silent(SCAN_TOPIC)}")
    beams = read_beams(recording.last_scan)
    stamps = recording.scans.array()["stamp"]
    second = float(recording.seconds(stamps[-1]))
    with drawing.applied():
        figure = _draw_scan(beams, second)
    moment = f"Scan on {SCAN_TOPIC} at {number(second)} s of robot time"
    return Picture(f"{moment}: {' '.join(_sentences(beams))} So far: {rate(stamps)}.", figure)


def _sentences(beams: Beams) -> list[str]:
    """The layout of the beams, how many see something, whether the message agrees with itself, and the nearest."""
    seen = int(beams.sees.sum())
    said = [f"{count(len(beams), 'beam')}."]
    if len(beams):
        ends = f"from {angle(beams.angles[0])} to {angle(beams.angles[-1])}, positive to the left"
        ranges = f"for ranges from {number(beams.least)} m to {number(beams.most)} m"
        said = [f"{count(len(beams), 'beam')} {ends}, {ranges}."]
        some = f"{count(seen, 'beam').capitalize()} of {len(beams)} {'sees' if seen < 2 else 'see'} something."
        said.append("All of them see something." if seen == len(beams) else some)
    if len(beams) != beams.asked:
        wanted = f"angle_min, angle_max and angle_increment ask for {beams.asked} readings"
        said.append(f"But its {wanted}: the message contradicts itself.")
    best = beams.nearest()
    if best is not None:
        by_side = {"": best, **beams.nearest_by_side()}
        nearest, *sides = (
            f"{side} {number(beams.ranges[beam])} m at {angle(beams.angles[beam])}" for side, beam in by_side.items()
        )
        said.append(f"The nearest is{nearest}. Nearest by side: {'; '.join(sides)}.")
    return said


def _draw_scan(beams: Beams, second: float) -> Figure:
    low, high, side = (-1.1 if beams.whole else -0.1), 1.1, 1.25
    width = 5.9
    height = width * (high - low) / (2 * side)
    figure = drawing.card(6.4, height + 0.82)
    figures = f"{int(beams.sees.sum())} of {len(beams)} beams see something"
    best, room = beams.nearest(), math.inf
    if best is not None:
        room = 1.3 * float(beams.ranges[best])  # the turtle is drawn as large as looks good, but it hides no hit
        degrees = number(math.degrees(beams.angles[best]), 0)
        figures += f", the nearest at {number(beams.ranges[best])} m, {degrees}°"
    subtitle = f"{SCAN_TOPIC} at {number(second, 1)} s of robot time  ·  {figures}"
    drawing.heading(figure, "What the obstacle detector sees", subtitle)
    axes = drawing.axes_at(figure, 0.25, 0.12, width, height)
    reach = reach_of(beams)
    axes.set(xlim=(-side * reach, side * reach), ylim=(low * reach, high * reach), aspect="equal")
    axes.axis("off")
    _draw_rings(axes, reach, beams.whole)
    _draw_beams(axes, beams, reach)
    draw_turtle(axes, 0.0, 0.0, math.pi / 2, length=max(0.02 * reach, min(0.075 * reach, room)))
    return figure


def reach_of(beams: Beams) -> float:
    """Return the range (m) at the picture's rim: the sensor's own, unless that is no useful number."""
    if math.isfinite(beams.most) and 0 < beams.most < 1000:
        return beams.most
    seen = beams.ranges[beams.sees]
    return max(1.2 * float(seen.max()), 0.1) if len(seen) else 1.0


def _draw_rings(axes: Axes, reach: float, whole: bool) -> None:
    """Draw range rings with their metres, and rays with their angles, over half a circle or a whole one."""
    from matplotlib.ticker import MaxNLocator

    label: dict[str, Any] = {"fontsize": 7.5, "color": drawing.INK, "va": "center"}
    side = math.pi if whole else math.pi / 2
    arc = np.linspace(-side, side, 181)
    steps = np.asarray(MaxNLocator(nbins=5, steps=[1, 2, 5, 10]).tick_values(0.0, reach))
    for ring in [*steps[(steps > 0) & (steps < reach - 0.3 * steps[1])], reach]:
        colour = drawing.INK if ring == reach else drawing.EDGE
        beside = np.where(np.abs(arc) * ring < 0.045 * reach, np.nan, arc)  # room for the metres
        axes.plot(*_polar(beside, np.full(len(arc), ring)), color=colour, linewidth=0.8, zorder=2)
        axes.text(*_polar(0.0, ring), f"{ring:g} m", zorder=4, ha="center", **label)
    for degrees in range(-180, 180, 30) if whole else range(-90, 91, 30):
        turn = math.radians(degrees)
        if degrees:
            axes.plot(*_polar(turn, np.array([0.0, reach])), color=drawing.LINE, linewidth=0.8, zorder=1)
            x, y = _polar(turn, reach * 1.03)
            text = f"{math.degrees(turn):+.0f}°\n{turn:+.2f} rad".replace("-", "−")
            align = "right" if x < -0.1 * reach else "left" if x > 0.1 * reach else "center"
            axes.text(x, y, text, linespacing=1.25, ha=align, **label)


def _draw_beams(axes: Axes, beams: Beams, reach: float) -> None:
    """Draw the space that the beams found free, a dot where one hit, and a ring around the nearest."""
    from matplotlib.collections import LineCollection

    nearest = beams.nearest()
    ends = np.where(beams.sees, np.minimum(beams.ranges, reach), reach)
    xs, ys = _polar(beams.angles, ends)
    axes.fill(np.append(xs, 0.0), np.append(ys, 0.0), color=drawing.SKY + "38", linewidth=0, zorder=1.5)
    rays = [((0.04 * x, 0.04 * y), (x, y)) for x, y in zip(xs, ys, strict=True)]
    axes.add_collection(LineCollection(rays, colors=drawing.SKY + "60", linewidths=0.5, zorder=1.6), autolim=False)
    if nearest is None:
        return
    dots: dict[str, Any] = {"marker": "o", "markersize": 3.4, "markeredgewidth": 0, "linestyle": "none"}
    axes.plot(xs[beams.sees], ys[beams.sees], color=drawing.VERMILLION, zorder=6, **dots)
    ring: dict[str, Any] = {"marker": "o", "markersize": 10, "markerfacecolor": "none", "markeredgewidth": 1.2}
    axes.plot(xs[nearest], ys[nearest], markeredgecolor=drawing.INK, zorder=7, **ring)


def _polar(angles: Any, ranges: Any) -> tuple[Any, Any]:
    """Places in the picture: forward is up, so left (a positive angle) is left."""
    return -np.sin(angles) * ranges, np.cos(angles) * ranges
