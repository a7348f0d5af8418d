"""The scene in meshcat's own commands, as bytes: what its viewer draws, wherever the bytes come from.

A view of a widget gets them over the notebook's channel, a saved page has them inside. meshcat's server is not used: it
listens on a port for everyone, and no proxy lets it through.
"""

from __future__ import annotations

import gzip
from collections.abc import Iterable
from functools import cache
from typing import Any

import numpy as np
import umsgpack

from .scene_mesh import Mesh
from .scene_meshcat import VIEWER, Delete, ScenePath, SetObject, SetProperty, SetTransform, geometry


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


def show_shape(path: str, shape: Any, **look: Any) -> bytes:
    """Show one of meshcat's own shapes."""
    return _show(path, shape, geometry.MeshLambertMaterial(**look))


def show_line(path: str, points: np.ndarray, colour: int) -> bytes:
    """Show a closed line through points (n by 3)."""
    corners = np.round(points, 4).astype(np.float32).T
    return _show(path, geometry.PointsGeometry(corners), geometry.LineBasicMaterial(color=colour), geometry.LineLoop)


def _show(path: str, shape: Any, material: Any, kind: Any = geometry.Mesh) -> bytes:
    thing = kind(shape, material)
    # meshcat's own names are made of the time: with these, the same scene is the same bytes
    shape.uuid, material.uuid, thing.uuid = f"{path}#shape", f"{path}#material", path
    return packed(SetObject(thing, path=_path(path)))


def put(path: str, matrix: np.ndarray) -> bytes:
    """Say where something is, by a 4 by 4 matrix."""
    return packed(SetTransform(np.round(np.asarray(matrix, float), 5), _path(path)))


def remove(path: str) -> bytes:
    """Take something away."""
    return packed(Delete(_path(path)))


def tell(path: str, name: str, value: Any) -> bytes:
    """Set a property of what is at a path."""
    return packed(_SetNamed(name, value, _path(path)))


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
