"""The path that the turtle drove, on the map of its world."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from . import style
from .drawing import draw_obstacles, draw_turtle
from .goals import Goal, draw_goal, read_goals
from .picture import Picture
from .recording import Obstacle, Recording
from .words import angle, count, number, point, turned

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WORLD = 11.088889
"""Side of turtlesim's square world in metres: 500 pixels of a field where a turtle's 45 pixels are a metre."""

SLACK = 0.05
"""A step longer than the speed explains by this much (m) is a jump: the turtle was put somewhere else."""


def plot_path(
    recording: Recording, *, goal: Any = None, since: float | None = None, until: float | None = None
) -> Picture:
    """Return the turtle's path as a Picture, from `since` to `until` (seconds since the lesson's start).

    `goal` marks one goal (x, y) or (x, y, theta) in metres and radians, or a list of them; raises ValueError
    for anything else. Without a pose, the Picture says why.
    """
    goals = read_goals(goal)
    poses = recording.window(recording.poses, since, until)
    if not len(poses):
        return Picture(_nothing(recording))
    commands = recording.window(recording.commands, since, until)
    jumps = find_jumps(poses)
    driven = distance_driven(poses, jumps)
    obstacles = list(recording.obstacles.values())
    sentences = [
        _journey(recording, poses, driven),
        _jumped(jumps),
        _at_wall(poses[-1]),
        _commanded(recording, commands),
    ]
    sentences += [_to_goal(each, poses[-1]) for each in goals]
    sentences.append(_standing(obstacles))
    with style.applied():
        figure = _draw(recording, poses, jumps, driven, goals, obstacles)
    return Picture(" ".join(filter(None, sentences)), figure)


def find_jumps(poses: np.ndarray) -> np.ndarray:
    """Return the indices of the poses that the turtle cannot have driven to: a teleport or a reset came before."""
    steps = np.hypot(np.diff(poses["x"]), np.diff(poses["y"]))
    fastest = np.maximum(np.abs(poses["speed"][1:]), np.abs(poses["speed"][:-1]))
    possible = fastest * np.diff(poses["stamp"]) / 1e9
    return np.flatnonzero(steps > 1.5 * possible + SLACK) + 1


def distance_driven(poses: np.ndarray, jumps: np.ndarray) -> float:
    """Return the length of the path in metres, jumps left out."""
    steps = np.hypot(np.diff(poses["x"]), np.diff(poses["y"]))
    steps[jumps - 1] = 0.0
    return math.fsum(steps)


# -- in words ----------------------------------------------------------------------------------------------------


def _nothing(recording: Recording) -> str:
    if not len(recording.poses):
        return f"No path yet. {recording.why_silent(recording.pose_topic)}"
    first, last = recording.seconds(recording.poses.array()["stamp"][[0, -1]])
    return f"No path in these seconds: the poses heard are from {number(first)} s to {number(last)} s of robot time."


def _journey(recording: Recording, poses: np.ndarray, driven: float) -> str:
    first, last = poses[0], poses[-1]
    begin, end = (number(recording.seconds(pose["stamp"])) for pose in (first, last))
    title = f"Path of {recording.turtle} from {begin} s to {end} s of robot time"
    here = f"{point(last['x'], last['y'])} m facing {angle(last['theta'])}"
    away = math.hypot(last["x"] - first["x"], last["y"] - first["y"])
    if max(driven, away) < 0.005:
        return f"{title}: it stayed at {here}."
    there = f"{point(first['x'], first['y'])} m facing {angle(first['theta'])}"
    return f"{title}: from {there} it drove {number(driven)} m to {here}, {number(away)} m from its start."


def _jumped(jumps: np.ndarray) -> str:
    return f"It was put elsewhere {count(len(jumps), 'time')} (teleport or reset)." if len(jumps) else ""


def _at_wall(pose: Any) -> str:
    touching = {
        "left": pose["x"] <= 0.001,
        "right": pose["x"] >= WORLD - 0.001,
        "lower": pose["y"] <= 0.001,
        "upper": pose["y"] >= WORLD - 0.001,
    }
    walls = [side for side, touched in touching.items() if touched]
    return f"It touches the {' and the '.join(walls)} wall." if walls else ""


def _commanded(recording: Recording, commands: np.ndarray) -> str:
    return f"{count(len(commands), 'command').capitalize()} on {recording.command_topic} in that time."


def _to_goal(goal: Goal, pose: Any) -> str:
    away = number(math.hypot(goal.x - pose["x"], goal.y - pose["y"]))
    if goal.theta is None:
        return f"The goal {point(goal.x, goal.y)} m is {away} m away."
    rest = angle(turned(goal.theta - pose["theta"]))
    return f"The goal {point(goal.x, goal.y)} m facing {angle(goal.theta)} is {away} m away, and a turn of {rest}."


def _standing(obstacles: list[Obstacle]) -> str:
    if not obstacles:
        return ""
    places = ", ".join(f"{each.shape} at {point(each.x, each.y)}" for each in obstacles)
    return f"{count(len(obstacles), 'obstacle').capitalize()} in the world: {places}."


# -- as a picture ------------------------------------------------------------------------------------------------


def _draw(
    recording: Recording,
    poses: np.ndarray,
    jumps: np.ndarray,
    driven: float,
    goals: list[Goal],
    obstacles: list[Obstacle],
) -> Any:
    figure = style.card(5.3, 5.6)
    begin, end = (number(recording.seconds(pose["stamp"]), 1) for pose in (poses[0], poses[-1]))
    style.heading(
        figure,
        f"Path of {recording.turtle}",
        f"{begin} s to {end} s of robot time  ·  {number(driven)} m driven",
    )
    axes = style.axes_at(figure, 0.55, 0.5, 4.5, 4.5)
    _draw_world(axes)
    draw_obstacles(axes, obstacles)
    _draw_trail(axes, poses, jumps)
    for goal in goals:
        draw_goal(axes, goal)
    last = poses[-1]
    draw_turtle(axes, last["x"], last["y"], last["theta"])
    return figure


def _draw_world(axes: Axes) -> None:
    axes.set(xlim=(0, WORLD), ylim=(0, WORLD), aspect="equal", xlabel="x in metres", ylabel="y in metres")
    axes.set_xticks(range(0, 12, 2))
    axes.set_yticks(range(0, 12, 2))
    axes.set_xticks(range(1, 12, 2), minor=True)
    axes.set_yticks(range(1, 12, 2), minor=True)
    axes.tick_params(which="both", length=0)
    axes.grid(True, which="both")
    for spine in axes.spines.values():
        spine.set(visible=True, color=style.INK, linewidth=1.4)
        spine.set_zorder(4)


def _draw_trail(axes: Axes, poses: np.ndarray, jumps: np.ndarray) -> None:
    """The trail, pale where it is old; a dotted line where the turtle was put elsewhere; chevrons along it."""
    from matplotlib.collections import LineCollection
    from matplotlib.colors import LinearSegmentedColormap

    shades = LinearSegmentedColormap.from_list("age", ["#a9d3ee", style.BLUE])
    places = np.column_stack([poses["x"], poses["y"]])
    for jump in jumps:
        axes.plot(*places[jump - 1 : jump + 1].T, color=style.GREY, linestyle=":", linewidth=1.0, zorder=3)
    chosen = _spaced(places, jumps)
    pieces = np.stack([places[chosen[:-1]], places[chosen[1:]]], axis=1)
    kept = ~np.isin(chosen[1:], jumps)
    if kept.any():
        ages = np.linspace(0.0, 1.0, len(pieces))[kept]
        axes.add_collection(
            LineCollection(
                list(pieces[kept]), colors=shades(ages), linewidths=2.2, capstyle="round", zorder=3
            ),
            autolim=False,
        )
        _draw_chevrons(axes, pieces[kept])
    _draw_start(axes, places)


def _spaced(places: np.ndarray, jumps: np.ndarray, spacing: float = 0.03) -> np.ndarray:
    """Indices of places about `spacing` metres apart, and of both sides of every jump, the first and the last."""
    steps = np.hypot(*np.diff(places, axis=0).T)
    bins = np.floor(np.concatenate([[0.0], np.cumsum(steps)]) / spacing)
    fresh = np.flatnonzero(np.diff(bins)) + 1
    return np.unique(np.concatenate([[0, len(places) - 1], fresh, jumps, jumps - 1]).astype(int))


def _draw_chevrons(axes: Axes, pieces: np.ndarray, size: float = 0.15) -> None:
    """Small arrow heads along the trail, evenly spaced, that show which way it was driven."""
    from matplotlib.collections import LineCollection

    ways = pieces[:, 1] - pieces[:, 0]
    lengths = np.hypot(*ways.T)
    total = float(lengths.sum())
    every = max(1.3, total / 14)
    marks = np.searchsorted(np.cumsum(lengths), np.arange(0.6 * every, total - 0.5, every))
    heads = []
    for mark in marks[lengths[marks] > 0]:
        along = ways[mark] / lengths[mark] * size
        across = np.array([-along[1], along[0]])
        tip = pieces[mark, 1] + along / 2
        heads.append([tip - along + across * 0.8, tip, tip - along - across * 0.8])
    axes.add_collection(
        LineCollection(heads, colors=style.BLUE, linewidths=1.6, capstyle="round", zorder=3.2), autolim=False
    )


def _draw_start(axes: Axes, places: np.ndarray) -> None:
    """A ring where the trail starts, and its name on the side that the trail does not take."""
    x, y = places[0]
    away = places[np.hypot(*(places - places[0]).T) > 0.5]
    ahead = math.atan2(*(away[0] - places[0])[::-1]) if len(away) else math.pi / 2
    edge = {"markerfacecolor": style.CARD, "markeredgecolor": style.BLUE, "markeredgewidth": 1.6}
    axes.plot([x], [y], marker="o", markersize=6.5, zorder=3.5, **edge)
    axes.annotate(
        "start",
        (x, y),
        xytext=(-20 * math.cos(ahead), -13 * math.sin(ahead)),
        textcoords="offset points",
        ha="center",
        va="center",
        fontsize=8.5,
        color=style.GREY,
        zorder=3.5,
    )
