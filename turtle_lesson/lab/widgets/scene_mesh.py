"""Shapes made of flat triangles, from which the 3-D scene and its picture are both drawn. Metres, z is up."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles that share no corner, so that each is flat and has a colour of its own."""

    corners: np.ndarray
    """Three points for each triangle: n by 3 by 3."""
    colours: np.ndarray
    """Red, green and blue from 0 to 1 for each triangle: n by 3."""

    def __len__(self) -> int:
        return len(self.corners)

    def moved(self, matrix: np.ndarray) -> Mesh:
        """The same mesh elsewhere: turned, stretched and shifted by a 4 by 4 matrix."""
        return Mesh(self.corners @ matrix[:3, :3].T + matrix[:3, 3], self.colours)

    def mirrored(self) -> Mesh:
        """The same mesh on the other side of the x axis."""
        return Mesh((self.corners * (1, -1, 1))[:, ::-1], self.colours)


def rgb(colour: str) -> tuple[float, float, float]:
    """A colour such as "#0072B2" as red, green and blue from 0 to 1."""
    return tuple(int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5))  # type: ignore[return-value]


def joined(meshes: Iterable[Mesh]) -> Mesh:
    """Several meshes as one."""
    listed = list(meshes) or [Mesh(np.zeros((0, 3, 3)), np.zeros((0, 3)))]
    return Mesh(np.concatenate([each.corners for each in listed]), np.concatenate([each.colours for each in listed]))


def triangles(corners: ArrayLike, colour: str) -> Mesh:
    """Triangles of one colour, from three points each."""
    points = np.asarray(corners, float).reshape(-1, 3, 3)
    return Mesh(points, np.tile(rgb(colour), (len(points), 1)))


def polygon(points: ArrayLike, colour: str) -> Mesh:
    """A flat convex piece, seen from where its points go round counter-clockwise."""
    places = np.asarray(points, float)
    return triangles([[places[0], places[at], places[at + 1]] for at in range(1, len(places) - 1)], colour)


def loft(rings: Sequence[ArrayLike], colour: str) -> Mesh:
    """The skin between rings of equally many points, from the lowest to the highest."""
    pieces = []
    for below, above in pairwise(rings):
        low, high = np.asarray(below, float), np.asarray(above, float)
        low_next, high_next = np.roll(low, -1, axis=0), np.roll(high, -1, axis=0)
        pieces += [np.stack([low, low_next, high_next], axis=1), np.stack([low, high_next, high], axis=1)]
    return triangles(np.concatenate(pieces), colour)


def ring(middle: Sequence[float], across: float, along: float, sides: int) -> np.ndarray:
    """Points around a middle, level, counter-clockwise."""
    turns = np.arange(sides) * math.tau / sides
    x, y, z = middle
    return np.column_stack([x + across * np.cos(turns), y + along * np.sin(turns), np.full(sides, z)])


def prism(outline: ArrayLike, low: float, high: float, colour: str) -> Mesh:
    """A wall along an outline (n by 2, counter-clockwise) with a lid."""
    flat = np.asarray(outline, float)
    bottom, top = (np.column_stack([flat, np.full(len(flat), z)]) for z in (low, high))
    return joined([loft([bottom, top], colour), polygon(top, colour)])


def ellipsoid(radii: Sequence[float], colour: str, sides: int = 8, levels: int = 5) -> Mesh:
    """An ellipsoid about the origin, of few faces."""
    angles = np.linspace(-math.pi / 2, math.pi / 2, levels + 1)
    rings = [
        ring((0, 0, radii[2] * math.sin(each)), radii[0] * math.cos(each), radii[1] * math.cos(each), sides)
        for each in angles
    ]
    return loft(rings, colour)


def placed(x: float = 0.0, y: float = 0.0, z: float = 0.0, turn: float = 0.0, size: float = 1.0) -> np.ndarray:
    """The 4 by 4 matrix that makes something `size` times as large, turns it about z (rad) and shifts it."""
    cos, sin = size * math.cos(turn), size * math.sin(turn)
    return np.array([[cos, -sin, 0, x], [sin, cos, 0, y], [0, 0, size, z], [0, 0, 0, 1.0]])
