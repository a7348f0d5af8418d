"""The 3-D scene as a picture that stays, for readers without a kernel: drawn from the same meshes, from one side."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import style
from ..path import WORLD, Trail
from ..picture import Picture
from ..scan import read_beams
from ..words import angle, count, listed, number, point
from . import scene_mesh
from .scene_mesh import Mesh, joined, placed, prism

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..recording import Recording
    from .goal_client import Goal


AROUND, UP = math.radians(-62), math.radians(40)
"""From where one looks: the direction in which the eye is, and its height above the horizon."""
LIGHT = np.array([-0.35, -0.45, 0.82])


def draw_scene(recording: Recording, goal: Goal | None) -> Picture:
    """Return the scene as it is now, with its text."""
    text = f"3-D scene: {describe(recording, goal)}"
    pose = recording.pose()
    if pose is None:
        return Picture(text)
    with style.applied():
        figure = style.card(6.4, 4.7)
        axes = style.axes_at(figure, 0.15, 0.15, 6.1, 4.0)
        axes.set(aspect="equal")
        axes.set_axis_off()
        _draw(axes, scene_mesh.floor(), layer=1, alpha=0.08)
        _draw(axes, scene_mesh.grid(), layer=2, alpha=0.5)
        trail = Trail()
        trail.follow(recording.poses)
        _draw(axes, scene_mesh.ribbon([*trail.old, trail.tip]), layer=3, lit=False)
        _draw_things(axes, recording, goal, pose)
        axes.autoscale_view(tight=True)
        style.heading(figure, "The world in three dimensions", brief(recording, goal, beams=False).rstrip("."))
    return Picture(text, figure)


def _draw_things(axes: Axes, recording: Recording, goal: Goal | None, pose: tuple[float, float, float]) -> None:
    """What stands there, the farthest first."""
    outlines = map(scene_mesh.outline, recording.obstacles.values())
    blocks = [prism(each, 0.0, scene_mesh.OBSTACLE_HEIGHT, scene_mesh.OBSTACLE) for each in outlines]
    things = [[each] for each in (*scene_mesh.walls(), *blocks)]
    there = placed(pose[0], pose[1], 0.0, pose[2])
    facing_us = math.cos(pose[2] - AROUND) > 0
    things.append([piece.moved(there) for piece in scene_mesh.layers(head_in_front=facing_us)])
    if goal is not None:
        _draw(axes, scene_mesh.goal_mark(goal.x, goal.y, goal.theta), layer=6, lit=False)
        things.append([scene_mesh.goal_flag(goal.x, goal.y, goal.state == "reached")])
    things.sort(key=lambda pieces: float(_seen(joined(pieces).corners)[2].mean()))
    for layer, piece in enumerate(piece for pieces in things for piece in pieces):
        _draw(axes, piece, layer=10 + layer)
    if place := recording.pose_at_scan():
        free, marks = scene_mesh.fan(read_beams(recording.last_scan), *place)
        _draw(axes, free, layer=4, lit=False, alpha=0.22)
        _draw(axes, marks, layer=5, lit=False, alpha=0.8)


def _draw(axes: Axes, mesh: Mesh, layer: float, lit: bool = True, **look: Any) -> None:
    """Draw those triangles that face the eye, the farthest first."""
    from matplotlib.collections import PolyCollection

    across, up, depth = _seen(mesh.corners)
    flat = np.stack([across, up], axis=2)
    colours = mesh.colours
    order = np.argsort(depth.mean(axis=1), kind="stable")
    if lit:
        colours = colours * _brightness(mesh)
        first, second = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
        order = order[(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0] > 0)[order]]
    edges: Any = {"edgecolors": "face", "linewidths": 0.25} if "alpha" not in look else {"edgecolors": "none"}
    faces = PolyCollection(list(flat[order]), facecolors=np.clip(colours[order], 0, 1), zorder=layer, **edges, **look)
    axes.add_collection(faces)


def _seen(points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points (…, 3) as the eye sees them: to the right, up, and towards it."""
    x, y, z = np.moveaxis(points - (WORLD / 2, WORLD / 2, 0), -1, 0)
    outward = x * math.cos(AROUND) + y * math.sin(AROUND)
    across = -x * math.sin(AROUND) + y * math.cos(AROUND)
    return across, -outward * math.sin(UP) + z * math.cos(UP), outward * math.cos(UP) + z * math.sin(UP)


def _brightness(mesh: Mesh) -> np.ndarray:
    """How bright each triangle is, by the light's direction: n by 1."""
    normals = np.cross(mesh.corners[:, 1] - mesh.corners[:, 0], mesh.corners[:, 2] - mesh.corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    facing = (normals @ LIGHT) / np.where(lengths > 0, lengths, 1.0)
    return (0.72 + 0.31 * np.maximum(facing, 0.0))[:, None]


def brief(recorder: Recording, goal: Goal | None, beams: bool = True) -> str:
    """A scene in a line: turtle, obstacles, laser and goal."""
    pose = recorder.pose()
    if pose is None:
        return "No pose heard yet."
    x, y, theta = pose
    facts = [f"Turtle at {point(x, y)} m facing {number(math.degrees(theta), 1)}°"]
    if recorder.obstacles:
        facts.append(count(len(recorder.obstacles), "obstacle"))
    if beams and recorder.last_scan is not None:
        scan = read_beams(recorder.last_scan)
        facts.append(f"{int(scan.sees.sum())} of {count(len(scan), 'beam')} see something")
    if goal is not None:
        facts.append(f"goal {number(math.hypot(goal.x - x, goal.y - y))} m away")
    return f"{'; '.join(facts)}."


def describe(recorder: Recording, goal: Goal | None) -> str:
    """A scene in one sentence: turtle, obstacles, laser and goal."""
    pose = recorder.pose()
    if pose is None:
        return "no pose heard yet."
    x, y, theta = pose
    around = []
    if standing := recorder.obstacles.values():
        places = ", ".join(f"{each.shape} at {point(each.x, each.y)} m" for each in standing)
        around.append(f"{count(len(standing), 'obstacle')} ({places})")
    if recorder.last_scan is not None:
        beams = read_beams(recorder.last_scan)
        around.append(f"{int(beams.sees.sum())} of the laser's {count(len(beams), 'beam')} see something")
    if goal is not None:
        away = number(math.hypot(goal.x - x, goal.y - y))
        around.append(f"the goal at {point(goal.x, goal.y)} m is {away} m away")
    rest = f"; {listed(around)}" if around else ""
    return f"the turtle is at {point(x, y)} m facing {angle(theta)}{rest}."
