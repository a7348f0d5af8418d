"""The world in three dimensions: meshcat's viewer inside a widget, fed over the notebook's own channel.

For readers without a kernel there is a picture that stays, drawn from the same meshes, from one side.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import traitlets

from .. import drawing
from ..drawing import Picture
from ..path import Trail
from ..recording import WORLD, Recording
from ..status_and_scan import read_beams
from ..words import angle, count, listed, number, point
from . import scene_commands, scene_mesh
from .backend import Link
from .goal_client import Goal
from .live_widget import LiveWidget
from .scene_commands import viewer_bundle
from .scene_mesh import Mesh, joined, placed, prism
from .scene_page import VIEW_SCRIPTS, ScenePage, replay_page, state_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

AROUND, UP = math.radians(-62), math.radians(40)
"""The viewpoint: the direction of the eye, and its height above the horizon, rad."""
LIGHT = np.array([-0.35, -0.45, 0.82])


def _commands() -> Any:
    """A trait for a part of the scene: meshcat commands, each as bytes, that bring it up to date."""
    return traitlets.List(traitlets.Bytes()).tag(sync=True)


class Scene(LiveWidget):
    """Floor, walls, obstacles, turtle, trail, laser and goal, to be turned under the mouse.

    The whole state is in the traits, one for each part of the scene, so that a view that comes late, a second window or a
    reloaded frame is complete at once; what has not changed is not sent again.
    """

    SCRIPTS = (*VIEW_SCRIPTS, "scene")
    STYLES = ("base", "scene")

    bundle = traitlets.Bytes().tag(sync=True)
    """The viewer's script, compressed; it travels once."""
    stage = _commands()
    turtle = traitlets.Bytes().tag(sync=True)
    """One command that says where the turtle is; empty until a pose was heard."""
    trail = _commands()
    """The older part of the trail."""
    tip = _commands()
    """Its newest piece."""
    scan = _commands()
    obstacles = _commands()
    goal = _commands()
    description = traitlets.Unicode().tag(sync=True)
    """The scene in words, for a screen reader."""

    def __init__(self, backend: Link) -> None:
        self._trail = Trail()
        super().__init__(backend, bundle=viewer_bundle(), stage=scene_commands.stage())
        self.tick()

    def snapshot(self) -> ScenePage:
        """The scene as it is now, as one page of HTML that needs neither kernel nor network.

        The page is shown where it is the last value of a cell; `save("scene.html")` writes it to a file.
        """
        self.redraw()
        return ScenePage("3-D scene", f"Snapshot of the {self.text()}", state_of(self))

    def animation(self) -> ScenePage:
        """The turtle's run as a page of HTML with a play bar. Raises ValueError where no pose was heard."""
        return replay_page(self)

    def _text(self) -> str:
        return f"3-D scene: {describe(self.backend.recorder, self._current_goal())}"

    def _picture(self) -> Picture | None:
        return draw_scene(self.backend.recorder, self._current_goal())

    def redraw(self) -> None:
        """Bring everything up to date, also what usually waits a little; of an ended world, nothing changes."""
        self._paces.clear()
        if not self.ended:
            self.tick()

    def tick(self) -> None:
        recorder = self.backend.recorder
        pose = recorder.pose()
        if pose is not None and self.is_new("turtle", pose):
            self.turtle = scene_commands.turtle_at(*pose)
        if self.due("trail", 10) and self._trail.follow(recorder.poses):
            if self.is_new("trail", self._trail.changes):
                self.trail = scene_commands.trail("lab/trail", self._trail.old)
            self.tip = scene_commands.trail("lab/tip", [self._trail.tip])
        if self.is_new("scan", recorder.scans.last()) and (scanned_from := recorder.pose_at_scan()) is not None:
            self.scan = scene_commands.scan(recorder.last_scan, *scanned_from)
        standing = list(recorder.obstacles.values())
        if self.is_new("obstacles", standing):
            self.obstacles = scene_commands.obstacles(standing)
        goal = self._current_goal()
        if self.is_new("goal", None if goal is None else (goal.x, goal.y, goal.theta, goal.state)):
            self.goal = scene_commands.goal(goal)
        if goal is not None and self.is_new("news", (goal.sent, goal.state)):
            self.words = f"Goal {point(goal.x, goal.y)} m: {goal.state}."
        if self.due("description", 1):
            self.description = brief(recorder, goal)

    def _current_goal(self) -> Goal | None:
        """The newest goal from this page, unless the navigator did not take it."""
        goals = [goal for goal in self.backend.recorder.goals if goal.state in ("on its way", "reached")]
        return goals[-1] if goals else None


def draw_scene(recording: Recording, goal: Goal | None) -> Picture:
    """Return the scene as it is now, with its text."""
    text = f"3-D scene: {describe(recording, goal)}"
    pose = recording.pose()
    if pose is None:
        return Picture(text)
    with drawing.applied():
        figure = drawing.card(6.4, 4.7)
        axes = drawing.axes_at(figure, 0.15, 0.15, 6.1, 4.0)
        axes.set(aspect="equal")
        axes.set_axis_off()
        _draw(axes, scene_mesh.floor(), layer=1, alpha=0.08)
        _draw(axes, scene_mesh.grid(), layer=2, alpha=0.5)
        trail = Trail()
        trail.follow(recording.poses)
        _draw(axes, scene_mesh.ribbon([*trail.old, trail.tip]), layer=3, lit=False)
        _draw_things(axes, recording, goal, pose)
        axes.autoscale_view(tight=True)
        drawing.heading(figure, "The world in three dimensions", brief(recording, goal).rstrip("."))
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
        normals = np.cross(mesh.corners[:, 1] - mesh.corners[:, 0], mesh.corners[:, 2] - mesh.corners[:, 0])
        lengths = np.linalg.norm(normals, axis=1)
        facing = (normals @ LIGHT) / np.where(lengths > 0, lengths, 1.0)
        colours = colours * (0.72 + 0.31 * np.maximum(facing, 0.0))[:, None]
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


def brief(recorder: Recording, goal: Goal | None) -> str:
    """A scene in a line: turtle, obstacles and goal."""
    pose = recorder.pose()
    if pose is None:
        return "No pose heard yet."
    x, y, theta = pose
    facts = [f"Turtle at {point(x, y)} m facing {number(math.degrees(theta), 1)}°"]
    if recorder.obstacles:
        facts.append(count(len(recorder.obstacles), "obstacle"))
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
