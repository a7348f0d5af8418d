"""The path that the turtle drove, on the map of its world."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from . import style
from .drawing import draw_obstacles, draw_turtle, turtle_points
from .path_geometry import WORLD, Goal, distance_driven, draw_goal, draw_trail, find_jumps, goal_points, read_goals
from .picture import Picture
from .recording import Obstacle, Recording
from .words import angle, count, number, point, turned

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def plot_path(
    recording: Recording, *, goal: Any = None, since: float | None = None, until: float | None = None
) -> Picture:
    """Return the turtle's path as a Picture, from `since` to `until` (seconds since the lesson's start).

    `goal` marks one goal (x, y) or (x, y, theta) in metres and radians, or a list of them; raises ValueError
    for anything else. Without a pose, the Picture says why.
    """
    goals = read_goals(goal)
    heard = recording.window(recording.poses, since, until)
    poses = heard[np.isfinite(heard["x"]) & np.isfinite(heard["y"]) & np.isfinite(heard["theta"])]
    broken = len(heard) - len(poses)
    if not len(poses):
        return Picture(_nothing(recording, broken))
    commands = len(recording.window(recording.commands, since, until))
    jumps = find_jumps(poses)
    driven = distance_driven(poses, jumps)
    sentences = [
        _journey(recording, poses, driven),
        f"It was put elsewhere {count(len(jumps), 'time')} (teleport or reset)." if len(jumps) else "",
        f"Left out: {count(broken, 'pose')} with nan, which is not a number." if broken else "",
        _at_wall(poses[-1]),
        f"{count(commands, 'command').capitalize()} on {recording.command_topic} in that time.",
        *(_to_goal(each, poses[-1]) for each in goals),
        _standing(list(recording.obstacles.values())),
    ]
    with style.applied():
        figure = _draw(recording, poses, jumps, driven, goals)
    return Picture(" ".join(filter(None, sentences)), figure)


# -- in words --------------------------------------------------------------------------------------------


def _nothing(recording: Recording, broken: int) -> str:
    if broken:
        return f"No path to draw: {count(broken, 'pose')} heard in that time, all with nan, which is not a number."
    if not len(recording.poses):
        return f"No path yet. {recording.why_silent(recording.pose_topic)}"
    return f"No path in these seconds: poses were heard from {recording.span(recording.poses)}."


def _journey(recording: Recording, poses: np.ndarray, driven: float) -> str:
    first, last = poses[0], poses[-1]
    begin, end = (number(recording.seconds(pose["stamp"])) for pose in (first, last))
    title = f"Path of {recording.turtle} from {begin} s to {end} s of robot time"
    here = f"{point(last['x'], last['y'])} m facing {angle(last['theta'])}"
    away = math.hypot(last["x"] - first["x"], last["y"] - first["y"])
    there = f"{point(first['x'], first['y'])} m facing {angle(first['theta'])}"
    if max(driven, away) >= 0.005:
        return f"{title}: from {there} it drove {number(driven)} m to {here}, {number(away)} m from its start."
    if angle(first["theta"]) != angle(last["theta"]):
        return f"{title}: from {there} it turned on the spot, and is now facing {angle(last['theta'])}."
    return f"{title}: it stayed at {here}."


def _at_wall(pose: Any) -> str:
    touching = {
        "left": pose["x"] <= 0.001,
        "right": pose["x"] >= WORLD - 0.001,
        "lower": pose["y"] <= 0.001,
        "upper": pose["y"] >= WORLD - 0.001,
    }
    walls = [side for side, touched in touching.items() if touched]
    return f"It touches the {' and the '.join(walls)} wall." if walls else ""


def _to_goal(goal: Goal, pose: Any) -> str:
    away = number(math.hypot(goal.x - pose["x"], goal.y - pose["y"]))
    place = f"The goal {point(goal.x, goal.y)} m"
    if goal.theta is None:
        return f"{place} is {away} m away."
    rest = angle(turned(goal.theta - pose["theta"]))
    return f"{place} facing {angle(goal.theta)} is {away} m away, and a turn of {rest}."


def _standing(obstacles: list[Obstacle]) -> str:
    if not obstacles:
        return ""
    places = ", ".join(f"{each.shape} at {point(each.x, each.y)} m" for each in obstacles)
    return f"{count(len(obstacles), 'obstacle').capitalize()} in the world: {places}."


# -- as a picture --------------------------------------------------------------------------------------------


def _draw(recording: Recording, poses: np.ndarray, jumps: np.ndarray, driven: float, goals: list[Goal]) -> Figure:
    figure = style.card(5.3, 5.6)
    begin, end = (number(recording.seconds(pose["stamp"]), 1) for pose in (poses[0], poses[-1]))
    subtitle = f"{begin} s to {end} s of robot time  ·  {number(driven)} m driven"
    style.heading(figure, f"Path of {recording.turtle}", subtitle)
    axes = style.axes_at(figure, 0.55, 0.5, 4.5, 4.5)
    _draw_world(axes)
    draw_obstacles(axes, recording.obstacles.values())
    last = poses[-1]
    signs = [turtle_points(last["x"], last["y"]), *map(goal_points, goals)]
    draw_trail(axes, poses, jumps, np.concatenate(signs))
    for goal in goals:
        draw_goal(axes, goal)
    draw_turtle(axes, last["x"], last["y"], last["theta"])
    return figure


def _draw_world(axes: Axes) -> None:
    axes.set(xlim=(0, WORLD), ylim=(0, WORLD), aspect="equal", xlabel="x in metres", ylabel="y in metres")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_ticks(range(0, 12, 2))
        axis.set_ticks(range(1, 12, 2), minor=True)
    axes.tick_params(which="both", length=0)
    axes.grid(True, which="both")
    for spine in axes.spines.values():
        spine.set(visible=True, color=style.INK, linewidth=1.4, zorder=4)
