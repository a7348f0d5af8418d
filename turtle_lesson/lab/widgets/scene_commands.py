"""The scene in meshcat's own commands, as bytes: what its viewer draws, wherever the bytes come from.

A view of a widget gets them over the notebook's channel, a saved page has them inside. meshcat's server is not used: it
listens on a port for everyone, and no proxy lets it through.
"""

from __future__ import annotations

import gzip
import warnings
from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import umsgpack

from ...ros.sim.defer_sigint import defer_sigint
from ..recording import WORLD, Obstacle
from ..status_and_scan import read_beams
from . import scene_mesh
from .goal_client import Goal
from .scene_mesh import Mesh, placed

# meshcat imports its server, which is never started here, and that a module of pyzmq that warns of its own age
with defer_sigint(), warnings.catch_warnings():
    warnings.simplefilter("ignore", DeprecationWarning)
    import meshcat
    from meshcat import geometry
    from meshcat.commands import Delete, SetObject, SetProperty, SetTransform
    from meshcat.path import Path as ScenePath

VIEWER = Path(meshcat.__file__).with_name("viewer") / "dist"


@cache
def viewer_bundle() -> bytes:
    """meshcat's viewer for the browser, one script with its licences, compressed by gzip to a quarter: 217 kB."""
    licences = (VIEWER / "main.min.js.LICENSE.txt").read_text(encoding="utf-8")
    notice = (VIEWER.parent / "LICENSE").read_text(encoding="utf-8").replace("*/", "* /")
    script = (VIEWER / "main.min.js").read_text(encoding="utf-8")
    return gzip.compress(f"/*! meshcat\n{notice}*/\n{licences}\n{script}".encode(), 9, mtime=0)


def packed(command: Any) -> bytes:
    """One command, in the form that the viewer reads."""
    return umsgpack.packb(command.lower())


def show(path: str, mesh: Mesh, lit: bool = True, **look: Any) -> bytes:
    """Show a mesh at a path such as "lab/turtle/body", in the colours of its triangles.

    `look` says how three.js draws it: `opacity=0.3`, `depthWrite=False`, … With `color=0x0072b2` it has that one colour.
    What is not `lit` looks the same in light and shade.
    """
    colours = None if "color" in look else np.round(np.repeat(mesh.colours, 3, axis=0), 4)
    corners = np.round(mesh.corners.reshape(-1, 3), 4)
    shape = geometry.TriangularMeshGeometry(corners, np.arange(len(corners)).reshape(-1, 3), colours)
    material = geometry.MeshLambertMaterial if lit else geometry.MeshBasicMaterial
    return _show(path, shape, material(vertexColors=colours is not None, **look))


def _show(path: str, shape: Any, material: Any, kind: Any = geometry.Mesh) -> bytes:
    return umsgpack.packb(_shown(path, shape, material, kind))


def _shown(path: str, shape: Any, material: Any, kind: Any) -> Any:
    thing = kind(shape, material)
    # meshcat's own names are made of the time: with these, the same scene is the same bytes
    shape.uuid, material.uuid, thing.uuid = f"{path}#shape", f"{path}#material", path
    return SetObject(thing, path=_path(path)).lower()


def put(path: str, matrix: np.ndarray) -> bytes:
    """Say where something is, by a 4 by 4 matrix."""
    numbers = np.empty(16, [("kind", "u1"), ("number", ">f8")])  # as msgpack has floats of 64 bits
    numbers["kind"], numbers["number"] = 0xCB, np.round(matrix, 5).T.ravel()
    return _put_head(path) + numbers.tobytes()


@cache
def _put_head(path: str) -> bytes:
    """The command without its 16 numbers, of 9 bytes each: for the turtle this is asked for at each frame."""
    return packed(SetTransform(np.eye(4), _path(path)))[: -16 * 9]


def remove(path: str) -> bytes:
    """Take something away."""
    return packed(Delete(_path(path)))


def tell(path: str, name: str, value: Any) -> bytes:
    """Set a property of what is at a path."""
    return packed(_SetNamed(name, value, _path(path)))


@cache
def cast_no_shadow(path: str) -> bytes:
    """The viewer lets everything throw a shadow: not so light, or what lies on the floor."""
    return tell(f"{path}/<object>", "castShadow", False)


def light(path: str, intensity: float, position: Iterable[float], reach: float = 9.0) -> bytes:
    """A light as far away as the sun, which throws shadows within `reach` metres of the middle."""
    box = {"left": -reach, "right": reach, "top": reach, "bottom": -reach, "near": 1.0, "far": 60.0, "zoom": 1.0}
    matrix = [1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0, *map(float, position), 1.0]
    shadow = {
        "bias": -0.0008,
        "radius": 2.5,
        "mapSize": [2048, 2048],
        "camera": {"type": "OrthographicCamera", "uuid": f"{path}#camera", **box},
    }
    lamp = {"type": "DirectionalLight", "uuid": path, "color": 0xFFFFFF, "intensity": intensity}
    data = {"object": {**lamp, "matrix": matrix, "shadow": shadow}, "geometries": [], "materials": []}
    return umsgpack.packb({"type": "set_object", "path": _path(path).lower(), "object": data})


def _path(path: str) -> ScenePath:
    return ScenePath(tuple(path.split("/")))


class _SetNamed(SetProperty):
    """meshcat writes a property's name in small letters, but three.js has names such as castShadow."""

    def lower(self) -> dict[str, Any]:
        return {"type": "set_property", "path": self.path.lower(), "property": self.key, "value": self.value}


# -- scene parts ----------------------------------------------------------------------------------------------------
# Each list of commands brings its part up to date, whatever was there. All paths are below "lab", whose origin is the lower
# left corner of the world; the viewer's own is its middle.

TURTLE = "lab/turtle"
SUN = (-5.0, -7.0, 14.0)
"""Where the light comes from that throws the shadows, m."""


@cache
def stage() -> list[bytes]:
    """What never changes, in any scene: lights, floor, walls and the turtle itself."""
    hidden = ("SpotLight", "PointLightNegativeX", "PointLightPositiveX")
    lights = [tell(f"Lights/{name}/<object>", "visible", False) for name in hidden]
    ours = [
        put("lab", placed(-WORLD / 2, -WORLD / 2)),
        *lights,
        light("Lights/Sun", 0.55, SUN),
        remove("Grid"),
        remove("Axes"),
    ]
    ours.append(show("lab/floor", scene_mesh.floor(), color=_number(scene_mesh.FLOOR)))
    ours += [show("lab/grid", scene_mesh.grid(), color=_number(scene_mesh.GRID)), cast_no_shadow("lab/grid")]
    for number, wall in enumerate(scene_mesh.walls()):
        ours.append(show(f"lab/walls/{number}", wall, color=_number(scene_mesh.WALL)))
    ours.append(show(f"{TURTLE}/body", scene_mesh.body()))
    for name, ((x, y), leg) in scene_mesh.legs().items():
        ours += [put(f"{TURTLE}/{name}", placed(x, y)), show(f"{TURTLE}/{name}/swing", leg)]
    return ours


def turtle_at(x: float, y: float, theta: float) -> bytes:
    """Where the turtle is."""
    return put(TURTLE, placed(x, y, 0.0, theta))


def trail(path: str, pieces: Sequence[np.ndarray]) -> list[bytes]:
    """A part of the trail, as a ribbon on the floor; nothing of it if there are no pieces."""
    return _flat(path, scene_mesh.ribbon(pieces), scene_mesh.TRAIL)


def scan(message: object, x: float, y: float, theta: float) -> list[bytes]:
    """What the laser saw, from where the turtle was just then."""
    free, marks = scene_mesh.fan(read_beams(message), x, y, theta)
    look = {"opacity": 0.2, "depthWrite": False}
    commands = _flat("lab/scan/free", free, scene_mesh.FREE, **look)
    return commands + _flat("lab/scan/hits", marks, scene_mesh.HIT, opacity=0.85)


def _flat(path: str, mesh: Mesh, colour: str, **look: Any) -> list[bytes]:
    """A mesh that light does not change; nothing of it if it is empty."""
    if not len(mesh):
        return [remove(path)]
    corners = np.round(mesh.corners.reshape(-1, 3), 4).astype(np.float32)
    order = np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)
    arrays = [umsgpack.packb(geometry.pack_numpy_array(each.T)) for each in (corners, order)]
    head, middle, end = _flat_without_arrays(path, color=_number(colour), **look)
    return [b"".join((head, arrays[0], middle, arrays[1], end)), cast_no_shadow(path)]


@cache
def _flat_without_arrays(path: str, **look: Any) -> list[bytes]:
    """The command that shows such a mesh, in three parts, between which its corners and their order belong.

    They are packed once, since trail and scan come several times a second, and packing takes longer than all else.
    """
    shape = geometry.TriangularMeshGeometry(np.zeros((3, 3)), np.zeros((1, 3)))
    command = _shown(path, shape, geometry.MeshBasicMaterial(vertexColors=False, **look), geometry.Mesh)
    data = command["object"]["geometries"][0]["data"]
    data["attributes"]["position"] = data["index"] = GAP
    return umsgpack.packb(command).split(umsgpack.packb(GAP))


GAP = "\0arrays\0"


def obstacles(these: Iterable[Obstacle]) -> list[bytes]:
    """The obstacles: cylinders and boxes, with a dark line around the top."""
    commands = [remove("lab/obstacles")]
    for number, each in enumerate(these):
        path = f"lab/obstacles/{number}"
        block, place = _block(each)
        outline = scene_mesh.outline(each)
        rim = np.column_stack([outline, np.full(len(outline), scene_mesh.OBSTACLE_HEIGHT + 0.003)])
        edge = geometry.PointsGeometry(np.round(rim, 4).astype(np.float32).T)
        line = geometry.LineBasicMaterial(color=_number(scene_mesh.OBSTACLE_EDGE))
        commands += [
            _show(f"{path}/block", block, geometry.MeshLambertMaterial(color=_number(scene_mesh.OBSTACLE))),
            put(f"{path}/block", place),
            _show(f"{path}/edge", edge, line, geometry.LineLoop),
            cast_no_shadow(f"{path}/edge"),
        ]
    return commands


def _block(obstacle: Obstacle) -> tuple[geometry.Geometry, np.ndarray]:
    """Its shape and place; a cylinder, whose axis is y in three.js, is put upright, and stretched if it is no circle."""
    wide, deep, high = obstacle.width, obstacle.height, scene_mesh.OBSTACLE_HEIGHT
    there = placed(obstacle.x, obstacle.y, high / 2, obstacle.angle)
    if obstacle.shape == "box":
        return geometry.Box([wide, deep, high]), there
    upright = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
    return geometry.Cylinder(high, wide / 2), there @ np.diag([1, deep / wide if wide else 1, 1, 1]) @ upright


def goal(current: Goal | None) -> list[bytes]:
    """The flag at the goal, or none."""
    if current is None:
        return [remove("lab/goal")]
    return [
        show("lab/goal/mark", scene_mesh.goal_mark(current.x, current.y, current.theta)),
        cast_no_shadow("lab/goal/mark"),
        show("lab/goal/flag", scene_mesh.goal_flag(current.x, current.y, current.state == "reached")),
    ]


def _number(colour: str) -> int:
    return int(colour[1:], 16)
