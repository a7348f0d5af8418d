"""The parts of the 3-D scene as commands for meshcat's viewer; each list brings its part up to date, whatever was there.

All lies below "lab", where the lower left corner of the world is (0, 0); the viewer's own middle is the world's.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache

import numpy as np

from ..beams import read_beams
from ..recording import Obstacle
from ..track import WORLD
from . import scene_turtle as turtle
from . import scene_world as world
from .goals import Goal
from .scene_commands import cast_no_shadow, light, put, remove, show, show_line, show_shape, tell
from .scene_mesh import placed, rgb
from .scene_meshcat import geometry

TURTLE = "lab/turtle"
SUN = (-5.0, -7.0, 14.0)
"""Where the light comes from that throws the shadows, m."""


@cache
def stage() -> list[bytes]:
    """What never changes, in any scene: lights, floor, walls and the turtle itself."""
    ours = [put("lab", placed(-WORLD / 2, -WORLD / 2)), *_lights(), remove("Grid"), remove("Axes")]
    ours.append(show("lab/floor", world.floor(), color=_number(world.FLOOR)))
    ours += [show("lab/grid", world.grid(), color=_number(world.GRID)), cast_no_shadow("lab/grid")]
    for number, wall in enumerate(world.walls()):
        ours.append(show(f"lab/walls/{number}", wall, color=_number(world.WALL)))
    ours.append(show(f"{TURTLE}/body", turtle.body()))
    for name, ((x, y), leg) in turtle.legs().items():
        ours += [put(f"{TURTLE}/{name}", placed(x, y)), show(f"{TURTLE}/{name}/swing", leg)]
    return ours


def _lights() -> list[bytes]:
    hidden = ("SpotLight", "PointLightNegativeX", "PointLightPositiveX")
    return [*(tell(f"Lights/{name}/<object>", "visible", False) for name in hidden), light("Lights/Sun", 0.55, SUN)]


def turtle_at(x: float, y: float, theta: float) -> bytes:
    """Where the turtle is."""
    return put(TURTLE, placed(x, y, 0.0, theta))


def trail(path: str, pieces: Sequence[np.ndarray]) -> list[bytes]:
    """A part of the trail, as a ribbon on the floor; nothing of it if there are no pieces."""
    mesh = world.ribbon(pieces)
    if not len(mesh):
        return [remove(path)]
    return [show(path, mesh, lit=False, color=_number(world.TRAIL)), cast_no_shadow(path)]


def scan(message: object, x: float, y: float, theta: float) -> list[bytes]:
    """What the laser saw, from where the turtle was just then."""
    free, marks = world.fan(read_beams(message), x, y, theta)
    look = {"opacity": 0.2, "depthWrite": False}
    drawn = [("lab/scan/free", free, world.FREE, look), ("lab/scan/hits", marks, world.HIT, {"opacity": 0.85})]
    commands = []
    for path, mesh, colour, material in drawn:
        if len(mesh):
            commands += [show(path, mesh, lit=False, color=_number(colour), **material), cast_no_shadow(path)]
        else:
            commands.append(remove(path))
    return commands


def obstacles(these: Iterable[Obstacle]) -> list[bytes]:
    """The obstacles: cylinders and boxes, with a dark line around the top."""
    commands = [remove("lab/obstacles")]
    for number, each in enumerate(these):
        path = f"lab/obstacles/{number}"
        commands += [show_shape(f"{path}/block", _block(each), color=_number(world.OBSTACLE))]
        commands += [put(f"{path}/block", _stand(each))]
        rim = np.column_stack([world.outline(each), np.full(len(world.outline(each)), world.OBSTACLE_HEIGHT + 0.003)])
        commands += [show_line(f"{path}/edge", rim, _number(world.OBSTACLE_EDGE)), cast_no_shadow(f"{path}/edge")]
    return commands


def _block(obstacle: Obstacle) -> geometry.Geometry:
    if obstacle.shape == "box":
        return geometry.Box([obstacle.width, obstacle.height, world.OBSTACLE_HEIGHT])
    return geometry.Cylinder(world.OBSTACLE_HEIGHT, obstacle.width / 2)


def _stand(obstacle: Obstacle) -> np.ndarray:
    """Its place; a cylinder, whose axis is y in three.js, is put upright, and stretched if it is no circle."""
    there = placed(obstacle.x, obstacle.y, world.OBSTACLE_HEIGHT / 2, obstacle.angle)
    if obstacle.shape == "box":
        return there
    upright = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
    return there @ np.diag([1, obstacle.height / obstacle.width if obstacle.width else 1, 1, 1]) @ upright


def goal(current: Goal | None) -> list[bytes]:
    """The flag at the goal, or none."""
    if current is None:
        return [remove("lab/goal")]
    return [
        show("lab/goal/mark", world.goal_mark(current.x, current.y, current.theta)),
        cast_no_shadow("lab/goal/mark"),
        show("lab/goal/flag", world.goal_flag(current.x, current.y, current.state == "reached")),
    ]


def _number(colour: str) -> int:
    return sum(round(255 * part) << shift for part, shift in zip(rgb(colour), (16, 8, 0), strict=True))
