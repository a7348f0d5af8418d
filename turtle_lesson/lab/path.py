"""The path that the turtle drove, on the map of its world: how far, where it jumped, its trail and its goals."""

from __future__ import annotations

import math
from contextlib import suppress
from numbers import Real
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import drawing
from .drawing import Picture, draw_obstacles, draw_turtle
from .recording import COMMAND_TOPIC, POSE_TOPIC, WORLD, Recording, Table
from .words import angle, count, number, point, turned

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TICK = 16_000_000
"""How often, in ns, turtlesim publishes a pose."""

LATEST = 1_000_000_000
"""How late, in ns, a pose is expected to come at most: what a busy kernel may take for something else."""

SLACK = 0.05
"""A step longer than the speed explains by this much (m) is a jump: the turtle was put somewhere else."""

TOLERANCE = 0.2
"""Metres within which a goal counts as reached: the radius of the ring around it."""

MOST_POINTS = 900
"""Points that a trail has in all."""

BEND, CLOSEST = 0.2, 0.02
"""A trail has a point also where the turtle has turned by so much (rad), if it is so far (m) from the one before."""

BANDS = 12
"""The trail is drawn in so many parts, the older the paler."""

LABEL = (0.45, 0.2)
"""Half the width and half the height of the word "start", m."""

SIGN = (0.45, 0.5)
"""Half the width and half the height of the turtle or of a goal's flag, m."""


Place = tuple[float, float]
"""x and y, m."""


def find_jumps(poses: np.ndarray) -> np.ndarray:
    """Return the indices of the poses that the turtle cannot have driven to: teleport or reset.

    `poses` has the fields `stamp` (ns), `x`, `y` (m) and `speed` (m/s). A stamp may be the time at which a pose was heard:
    on a robot a busy kernel takes poses in bursts, each at least one tick of the simulator younger than the one before.
    """
    steps, stamps = _steps(poses), poses["stamp"]
    fastest = np.maximum(np.abs(poses["speed"][1:]), np.abs(poses["speed"][:-1]))
    behind = stamps - TICK * np.arange(len(poses))
    late = np.minimum(behind - np.minimum.accumulate(behind), LATEST)  # how long ago a pose may have been sent
    possible = fastest * (np.maximum(np.diff(stamps), TICK) + late[:-1]) / 1e9
    return np.flatnonzero(steps > 1.5 * possible + SLACK) + 1


def distance_driven(poses: np.ndarray, jumps: np.ndarray) -> float:
    """Return the length of the track in metres, jumps left out."""
    steps = _steps(poses)
    steps[jumps - 1] = 0.0
    return math.fsum(steps)


def thinned(poses: np.ndarray, jumps: np.ndarray) -> np.ndarray:
    """Return indices of poses about 3 cm apart, with both sides of each jump and both ends."""
    way = np.concatenate([[0.0], np.cumsum(_steps(poses))])
    fresh = np.flatnonzero(np.diff(np.floor(way / 0.03))) + 1
    return np.unique(np.concatenate([[0, len(poses) - 1], fresh, jumps, jumps - 1]).astype(int))


def _steps(poses: np.ndarray) -> np.ndarray:
    return np.hypot(np.diff(poses["x"]), np.diff(poses["y"]))


class Trail:
    """The turtle's way in few points, from a table of poses. `old` changes now and then, `tip` all the time.

    Points are `spacing` metres apart, nearer in bends. The newest piece has at most `tip` of them, all pieces together `most`:
    the oldest go.
    """

    def __init__(self, spacing: float = 0.1, tip: int = 24, most: int = MOST_POINTS) -> None:
        self._spacing, self._longest, self._most = spacing, tip, most
        self._seen = -1
        self._here: list[Place] = []
        """The newest place, if any was heard."""
        self._heading = 0.0
        self._tip: list[Place] = []
        self.old: list[np.ndarray] = []
        """The pieces that change no more: each n by 2, m."""
        self.changes = 0
        """How often `old` has changed."""

    @property
    def tip(self) -> np.ndarray:
        """The newest piece, to where the turtle is now: n by 2, m."""
        return np.array(self._tip + self._here).reshape(-1, 2)

    def follow(self, poses: Table) -> bool:
        """Take in what was heard since the last time; returns whether there was anything new to draw."""
        rows = poses.after(self._seen - 1)  # from the last one that was seen
        rows = rows[np.isfinite(rows["x"]) & np.isfinite(rows["y"])]
        known = int((rows["stamp"] <= self._seen).sum())
        places: list[Place] = list(zip(rows["x"].tolist(), rows["y"].tolist(), strict=True))
        if len(places) == known:
            return False
        headings = rows["theta"].tolist()
        jumps = set(find_jumps(rows).tolist())
        moved = any([place] != self._here for place in places[known:])
        for index in range(known, len(places)):
            if index in jumps:
                self._tip += self._here
                self._finish([])
            far = math.dist(self._tip[-1], places[index]) if self._tip else math.inf
            turned = BEND < abs(headings[index] - self._heading) < math.tau - BEND
            if far >= self._spacing or (turned and far >= CLOSEST):
                self._tip.append(places[index])
                self._heading = headings[index]
                if len(self._tip) >= self._longest:
                    self._finish([places[index]])
            self._here = [places[index]]
        self._seen = int(rows["stamp"][-1])
        return moved

    def _finish(self, begin: list[Place]) -> None:
        """The newest piece is done; another one begins."""
        if len(self._tip) > 1:
            self.old.append(np.array(self._tip))
        while sum(map(len, self.old)) > self._most:
            del self.old[0]
        self._tip = begin
        self.changes += 1


def plot_path(recording: Recording, *, goal: Any = None) -> Picture:
    """Return the turtle's path as a Picture.

    `goal` marks one goal (x, y) or (x, y, theta) in metres and radians, or a list of them; raises ValueError
    for anything else. Without a pose, the Picture says why.
    """
    goals = read_goals(goal)
    heard = recording.poses.array()
    poses = heard[np.isfinite(heard["x"]) & np.isfinite(heard["y"]) & np.isfinite(heard["theta"])]
    broken = len(heard) - len(poses)
    if not len(heard):
        return Picture(f"No path yet. {recording.why_silent(POSE_TOPIC)}")
    if not len(poses):
        return Picture(f"No path to draw: {count(broken, 'pose')} heard, all with nan, which is not a number.")
    jumps = find_jumps(poses)
    driven = distance_driven(poses, jumps)
    x, y = poses[-1]["x"], poses[-1]["y"]
    gaps = {"left": x, "right": WORLD - x, "lower": y, "upper": WORLD - y}
    walls = [side for side, gap in gaps.items() if gap <= 0.001]
    places = [f"{each.shape} at {point(each.x, each.y)} m" for each in recording.obstacles.values()]
    sentences = [
        _journey(recording, poses, driven),
        f"It was put elsewhere {count(len(jumps), 'time')} (teleport or reset)." if len(jumps) else "",
        f"Left out: {count(broken, 'pose')} with nan, which is not a number." if broken else "",
        f"It touches the {' and the '.join(walls)} wall." if walls else "",
        f"{count(len(recording.commands), 'command').capitalize()} on {COMMAND_TOPIC} in that time.",
        *(_to_goal(each, poses[-1]) for each in goals),
        f"{count(len(places), 'obstacle').capitalize()} in the world: {', '.join(places)}." if places else "",
    ]
    with drawing.applied():
        figure = _draw(recording, poses, jumps, driven, goals)
    return Picture(" ".join(filter(None, sentences)), figure)


def _journey(recording: Recording, poses: np.ndarray, driven: float) -> str:
    first, last = poses[0], poses[-1]
    begin, end = (number(recording.seconds(pose["stamp"])) for pose in (first, last))
    title = f"Path of turtle1 from {begin} s to {end} s of robot time"
    here = f"{point(last['x'], last['y'])} m facing {angle(last['theta'])}"
    there = f"{point(first['x'], first['y'])} m facing {angle(first['theta'])}"
    away = math.hypot(last["x"] - first["x"], last["y"] - first["y"])
    if max(driven, away) >= 0.005:
        return f"{title}: from {there} it drove {number(driven)} m to {here}, {number(away)} m from its start."
    if angle(first["theta"]) != angle(last["theta"]):
        return f"{title}: from {there} it turned on the spot, and is now facing {angle(last['theta'])}."
    return f"{title}: it stayed at {here}."


def _to_goal(goal: Goal, pose: Any) -> str:
    away = number(math.hypot(goal.x - pose["x"], goal.y - pose["y"]))
    place = f"The goal {point(goal.x, goal.y)} m"
    if goal.theta is None:
        return f"{place} is {away} m away."
    rest = angle(turned(goal.theta - pose["theta"]))
    return f"{place} facing {angle(goal.theta)} is {away} m away, and a turn of {rest}."


def _draw(recording: Recording, poses: np.ndarray, jumps: np.ndarray, driven: float, goals: list[Goal]) -> Figure:
    figure = drawing.card(5.3, 5.6)
    begin, end = (number(recording.seconds(pose["stamp"]), 1) for pose in (poses[0], poses[-1]))
    subtitle = f"{begin} s to {end} s of robot time  ·  {number(driven)} m driven"
    drawing.heading(figure, "Path of turtle1", subtitle)
    axes = drawing.axes_at(figure, 0.55, 0.5, 4.5, 4.5)
    axes.set(xlim=(0, WORLD), ylim=(0, WORLD), aspect="equal", xlabel="x in metres", ylabel="y in metres")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_ticks(range(0, 12, 2))
        axis.set_ticks(range(1, 12, 2), minor=True)
    axes.tick_params(which="both", length=0)
    axes.grid(True, which="both")
    for spine in axes.spines.values():
        spine.set(visible=True, color=drawing.INK, linewidth=1.4, zorder=4)
    draw_obstacles(axes, recording.obstacles.values())
    last = poses[-1]
    _draw_trail(axes, poses, jumps, [(last["x"], last["y"]), *((goal.x, goal.y + 0.35) for goal in goals)])
    for goal in goals:
        _draw_goal(axes, goal)
    draw_turtle(axes, last["x"], last["y"], last["theta"])
    return figure


def _draw_trail(axes: Axes, poses: np.ndarray, jumps: np.ndarray, signs: list[Place]) -> None:
    """Draw the trail of `poses` (fields `x`, `y` in metres), dotted where a jump leads to a pose.

    `signs` are the middles of the turtle and of the flags, which its label must not cover.
    """
    places = np.column_stack([poses["x"], poses["y"]])
    for jump in jumps:
        axes.plot(*places[jump - 1 : jump + 1].T, color=drawing.INK, linestyle=":", linewidth=1.0, zorder=3)
    chosen = thinned(poses, jumps)
    look: dict[str, Any] = {"color": drawing.BLUE, "linewidth": 2.2, "solid_capstyle": "butt", "zorder": 3}
    for band, part in enumerate(np.array_split(np.arange(len(chosen) - 1), BANDS)):
        if len(part):
            rows = chosen[part[0] : part[-1] + 2]
            path = np.insert(places[rows], np.flatnonzero(np.isin(rows[1:], jumps)) + 1, np.nan, axis=0)
            axes.plot(*path.T, alpha=0.3 + 0.7 * band / (BANDS - 1), **look)
    pieces = np.stack([places[chosen[:-1]], places[chosen[1:]]], axis=1)
    _draw_heads(axes, pieces[~np.isin(chosen[1:], jumps)])
    _draw_start(axes, places, places[chosen], np.array(signs))


def _draw_heads(axes: Axes, pieces: np.ndarray, size: float = 0.15) -> None:
    """Open arrow heads along the trail, evenly spaced: 1.3 m apart, or more on a long trail."""
    from matplotlib.collections import LineCollection

    ways = pieces[:, 1] - pieces[:, 0]
    lengths = np.hypot(*ways.T)
    total = float(lengths.sum())
    every = max(1.3, total / 14)
    marks = np.searchsorted(np.cumsum(lengths), np.arange(0.6 * every, total - 0.5, every))
    heads = []
    for mark in marks[lengths[marks] > 0]:
        along = ways[mark] / lengths[mark] * size
        across = 0.8 * np.array([-along[1], along[0]])
        tip = pieces[mark, 1] + along / 2
        heads.append([tip - along + across, tip, tip - along - across])
    look: dict[str, Any] = {"colors": drawing.BLUE, "linewidths": 1.6, "capstyle": "round", "zorder": 3.2}
    axes.add_collection(LineCollection(heads, **look), autolim=False)


def _draw_start(axes: Axes, places: np.ndarray, trail: np.ndarray, signs: np.ndarray) -> None:
    """A ring where the trail starts, and its name beside it, where it covers as little as possible."""
    x, y = places[0]
    away = places[np.hypot(*(places - places[0]).T) > 0.5]
    behind = math.atan2(*(places[0] - away[0])[::-1]) if len(away) else -math.pi / 2
    ring: dict[str, Any] = {"markerfacecolor": "#d3e6f3", "markeredgecolor": drawing.BLUE, "markeredgewidth": 1.6}
    axes.plot([x], [y], marker="o", markersize=6.5, zorder=3.5, **ring)
    turns = np.array([behind + sign * math.pi / 4 * step for step in range(5) for sign in (1, -1)])
    round_it = np.column_stack([0.68 * np.cos(turns), 0.45 * np.sin(turns)])
    free = np.concatenate([places[0] + far * round_it for far in (1.0, 1.6, 2.2, 3.0)])
    free = np.clip(free, np.array(LABEL) + 0.05, WORLD - 0.05 - np.array(LABEL))
    covered = [
        (np.abs(trail - place) < LABEL).all(axis=1).sum()
        + 20 * (np.abs(signs - place) < np.add(LABEL, SIGN)).all(axis=1).sum()
        for place in free
    ]
    across, up = free[np.argmin(covered)]
    axes.text(across, up, "start", ha="center", va="center", fontsize=8.5, color=drawing.INK, zorder=3.5)


class Goal(NamedTuple):
    """A place in metres, and the heading in radians to end with, if any."""

    x: float
    y: float
    theta: float | None = None


def read_goals(given: Any) -> list[Goal]:
    """Return the goals that were given as None, (x, y), (x, y, theta), or a list of these."""
    if given is None:
        return []
    with suppress(TypeError, ValueError):
        items = list(given)
        one = items and all(isinstance(item, Real) for item in items)
        goals = [Goal(*map(float, item)) for item in ([items] if one else items)]
        if all(math.isfinite(value) for goal in goals for value in goal if value is not None):
            return goals
    raise ValueError(
        "a goal is (x, y) in metres, or (x, y, theta) with the heading in radians, or a list of these; "
        f"got {given!r}; try goal=(8.0, 8.0, 1.57)"
    )


def _draw_goal(axes: Axes, goal: Goal) -> None:
    """Draw a flag, the ring within which the goal counts as reached, and on it a pointer for the heading."""
    from matplotlib.patches import Circle, Polygon

    x, y, colour = goal.x, goal.y, drawing.VERMILLION
    axes.add_artist(Circle((x, y), TOLERANCE, facecolor=colour + "22", edgecolor=colour, linewidth=1.2, zorder=4))
    axes.plot([x, x], [y, y + 0.85], color=drawing.INK, linewidth=1.3, zorder=7, solid_capstyle="round")
    flag = [(x, y + 0.87), (x + 0.44, y + 0.71), (x, y + 0.55)]
    axes.add_artist(Polygon(flag, closed=True, facecolor=colour, edgecolor="none", zorder=7))
    if goal.theta is not None:
        corners = ((TOLERANCE + 0.24, 0.0), (TOLERANCE + 0.04, 0.75), (TOLERANCE + 0.04, -0.75))
        pointer = [(x + r * math.cos(goal.theta + turn), y + r * math.sin(goal.theta + turn)) for r, turn in corners]
        axes.add_artist(Polygon(pointer, closed=True, facecolor=colour, edgecolor="none", zorder=4.1))
