"""The scene in meshcat's own commands, as bytes: what its viewer draws, wherever the bytes come from.

A view of a widget gets them over the notebook's channel, a saved page has them inside. meshcat's Python package is not
imported: its server listens on a port for everyone, and no proxy lets it through. The commands are those of its
commands.py and geometry.py; objects are written as three.js' ObjectLoader reads them.
"""

from __future__ import annotations

import gzip
from collections.abc import Iterable, Sequence
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import umsgpack

from ...turtlesim.obstacles import Circle, Obstacle
from ..recording import WORLD
from ..status_and_scan import read_beams
from . import scene_mesh
from .goal_client import Goal
from .scene_mesh import Mesh, placed

FLOATS = 0x17
"""The type, in the viewer's msgpack, of an array of floats of 32 bits."""


@cache
def viewer_bundle() -> bytes:
    """meshcat's viewer for the browser, one script with its licences, compressed by gzip to a quarter: 217 kB."""
    package = find_spec("meshcat")
    assert package is not None and package.origin is not None
    viewer = Path(package.origin).with_name("viewer")
    licences = (viewer / "dist" / "main.min.js.LICENSE.txt").read_text(encoding="utf-8")
    notice = (viewer / "LICENSE").read_text(encoding="utf-8").replace("*/", "* /")
    script = (viewer / "dist" / "main.min.js").read_text(encoding="utf-8")
    return gzip.compress(f"/*! meshcat\n{notice}*/\n{licences}\n{script}".encode(), 9, mtime=0)


def packed(kind: str, path: str, **content: Any) -> bytes:
    """One command about what is at a path such as "lab/turtle/body", in the form that the viewer reads."""
    return umsgpack.packb({"type": kind, "path": f"/{path}", **content})


def show(path: str, mesh: Mesh, lit: bool = True, **look: Any) -> bytes:
    """Show a mesh in the colours of its triangles.

    `look` says how three.js draws it: `opacity=0.3`, `depthWrite=False`, … With `color=0x0072b2` it has that one colour.
    What is not `lit` looks the same in light and shade.
    """
    shape = _points(mesh.corners)
    if "color" not in look:
        shape["data"]["attributes"]["color"] = _array(np.repeat(mesh.colours, 3, axis=0))
        look["vertexColors"] = 2
    return _show(path, shape, {"type": "MeshLambertMaterial" if lit else "MeshBasicMaterial", **look})


def _points(points: np.ndarray) -> dict[str, Any]:
    return {"type": "BufferGeometry", "data": {"attributes": {"position": _array(points)}}}


def _array(rows: np.ndarray) -> dict[str, Any]:
    numbers = np.round(rows, 4).astype("<f4").tobytes()
    return {"itemSize": 3, "type": "Float32Array", "array": umsgpack.Ext(FLOATS, numbers), "normalized": False}


def _show(path: str, shape: dict[str, Any], material: dict[str, Any], kind: str = "Mesh") -> bytes:
    shape, material = {"uuid": f"{path}#shape", **shape}, {"uuid": f"{path}#material", "side": 2, **material}
    material["transparent"] = "opacity" in material
    thing = {"uuid": path, "type": kind, "geometry": shape["uuid"], "material": material["uuid"]}
    return packed("set_object", path, object={"object": thing, "geometries": [shape], "materials": [material]})


def put(path: str, matrix: np.ndarray) -> bytes:
    """Say where something is, by a 4 by 4 matrix."""
    return packed("set_transform", path, matrix=np.round(matrix, 5).T.ravel().tolist())


def remove(path: str) -> bytes:
    """Take something away."""
    return packed("delete", path)


def tell(path: str, name: str, value: Any) -> bytes:
    """Set a property of what is at a path."""
    return packed("set_property", path, property=name, value=value)


@cache
def cast_no_shadow(path: str) -> bytes:
    """The viewer lets everything throw a shadow: not so light, or what lies on the floor."""
    return tell(f"{path}/<object>", "castShadow", False)


# -- scene parts ----------------------------------------------------------------------------------------------------
# Each list of commands brings its part up to date, whatever was there. All paths are below "lab", whose origin is the lower
# left corner of the world; the viewer's own is its middle.

TURTLE = "lab/turtle"
SUN = (-5.0, -7.0, 14.0)
"""Where the light comes from that throws the shadows, m; as that of the sun it comes from one direction."""
REACH = 9.0
"""How far from the middle there are shadows, m."""


@cache
def stage() -> list[bytes]:
    """What never changes, in any scene: lights, floor, walls and the turtle itself."""
    hidden = ("SpotLight", "PointLightNegativeX", "PointLightPositiveX")
    ours = [
        put("lab", placed(-WORLD / 2, -WORLD / 2)),
        *(tell(f"Lights/{name}/<object>", "visible", False) for name in hidden),
        _sun("Lights/Sun"),
        remove("Grid"),
        remove("Axes"),
        show("lab/floor", scene_mesh.floor(), color=_number(scene_mesh.FLOOR)),
        show("lab/grid", scene_mesh.grid(), color=_number(scene_mesh.GRID)),
        cast_no_shadow("lab/grid"),
        show(f"{TURTLE}/body", scene_mesh.body()),
    ]
    for number, wall in enumerate(scene_mesh.walls()):
        ours.append(show(f"lab/walls/{number}", wall, color=_number(scene_mesh.WALL)))
    for name, ((x, y), leg) in scene_mesh.legs().items():
        ours += [put(f"{TURTLE}/{name}", placed(x, y)), show(f"{TURTLE}/{name}/swing", leg)]
    return ours


def _sun(path: str) -> bytes:
    box = {"left": -REACH, "right": REACH, "top": REACH, "bottom": -REACH, "near": 1.0, "far": 60.0, "zoom": 1.0}
    camera = {"type": "OrthographicCamera", "uuid": f"{path}#camera", **box}
    shadow = {"bias": -0.0008, "radius": 2.5, "mapSize": [2048, 2048], "camera": camera}
    matrix = placed(*SUN).T.ravel().tolist()
    lamp = {"type": "DirectionalLight", "uuid": path, "color": 0xFFFFFF, "intensity": 0.55}
    data = {"object": {**lamp, "matrix": matrix, "shadow": shadow}, "geometries": [], "materials": []}
    return packed("set_object", path, object=data)


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
    return [show(path, mesh, lit=False, color=_number(colour), **look), cast_no_shadow(path)]


def obstacles(these: Iterable[Obstacle]) -> list[bytes]:
    """The obstacles: cylinders and boxes, with a dark line around the top."""
    commands = [remove("lab/obstacles")]
    high = scene_mesh.OBSTACLE_HEIGHT
    for number, each in enumerate(these):
        path = f"lab/obstacles/{number}"
        place = placed(each.x, each.y, high / 2, each.angle)
        block: dict[str, Any] = {"type": "BoxGeometry", "width": each.width, "height": each.height, "depth": high}
        if isinstance(each, Circle):  # a cylinder, whose axis is y in three.js, is put upright
            block = {"type": "CylinderGeometry", "height": high, "radialSegments": 50}
            block |= {"radiusTop": each.radius, "radiusBottom": each.radius}
            place @= np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
        rim = scene_mesh.lifted(scene_mesh.outline(each), high + 0.003)
        line = {"type": "LineBasicMaterial", "color": _number(scene_mesh.OBSTACLE_EDGE)}
        commands += [
            _show(f"{path}/block", block, {"type": "MeshLambertMaterial", "color": _number(scene_mesh.OBSTACLE)}),
            put(f"{path}/block", place),
            _show(f"{path}/edge", _points(rim), line, "LineLoop"),
            cast_no_shadow(f"{path}/edge"),
        ]
    return commands


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
