"""The turtle in three dimensions, of few flat faces: the same turtle as in the plots, which shows it from above."""

from __future__ import annotations

import math

import numpy as np

from ..drawing import BACK, BODY, HEAD, LEGS, OUTLINE, RIM, SHELL, SKIN, TAIL
from .scene_mesh import Mesh, ellipsoid, joined, loft, placed, polygon, ring

LENGTH = 0.95
"""From its nose to its tail, m. All that follows is in parts of this length: it looks along +x, its middle is (0, 0)."""

CREST = "#2fb98f"
"""The plates along the middle of its back."""
SEAM = "#d8f3e6"
BELLY, EDGE, TOP = 0.075, 0.145, 0.36
"""Heights of the belly, of the shell's edge and of its highest point."""

HIPS = ((0.17, 0.16), (-0.19, 0.15))
"""About these points its legs swing, the front one and the hind one on the left."""


def body() -> Mesh:
    """All of it but the legs."""
    return joined([_rim(), _seams(), _plates(), _head(), _tail()]).moved(placed(size=LENGTH))


def legs() -> dict[str, tuple[tuple[float, float], Mesh]]:
    """By name, the point (m) about which each leg swings, and the leg as seen from there."""
    made = {}
    for name, hip, shape in zip(("front", "hind"), HIPS, LEGS, strict=True):
        left = _leg(shape, hip)
        x, y = (LENGTH * each for each in hip)
        made[f"{name}_left"] = ((x, y), left)
        made[f"{name}_right"] = ((x, -y), left.mirrored())
    return made


def layers(head_in_front: bool) -> list[Mesh]:
    """The turtle standing still, as pieces, each of which hides the pieces before it when seen from above."""
    standing = joined([_tail(), *(leg.moved(placed(x, y, size=1 / LENGTH)) for (x, y), leg in legs().values())])
    order = [_rim(), _seams(), _plates()]
    pieces = [standing, *order, _head()] if head_in_front else [standing, _head(), *order]
    return [piece.moved(placed(size=LENGTH)) for piece in pieces]


def _leg(shape: tuple[float, ...], hip: tuple[float, float]) -> Mesh:
    x, y, width, height, turn = shape
    foot = ellipsoid((width / 2, height / 2, 0.06), SKIN, sides=8, levels=4)
    return foot.moved(placed(x - hip[0], y - hip[1], 0.062, math.radians(turn))).moved(placed(size=LENGTH))


def _rim() -> Mesh:
    """The belt around the shell, and the belly below it."""
    middle, across, along = BODY[0], BODY[2] / 2, BODY[3] / 2
    belt = [
        ring((middle, 0, BELLY), 0.86 * across, 0.84 * along, 12),
        ring((middle, 0, BELLY + 0.03), across, along, 12),
        ring((middle, 0, EDGE), 0.93 * across, 0.92 * along, 12),
        ring((middle, 0, EDGE + 0.01), 0.6 * across, 0.6 * along, 12),
    ]
    return joined([loft(belt, RIM), polygon(belt[0][::-1], SKIN)])


def _seams() -> Mesh:
    """A pale dome just below the plates: it is seen between them."""
    dome = [_ring_of_shell(radius, 12, -0.013) for radius in (1.12, 0.98, 0.56)]
    dome[2][1::2] = (dome[2][0::2] + np.roll(dome[2][0::2], -1, axis=0)) / 2  # a hexagon, as the plates have it
    return joined([loft(dome, SEAM), polygon(dome[-1], SEAM)])


def _plates() -> Mesh:
    """The shell: six plates around a hexagon."""
    crest = polygon(_shrunk(_ring_of_shell(0.56, 6)), CREST)
    return joined([crest, *(_plate(number) for number in range(6))])


def _plate(number: int) -> Mesh:
    """One of the six plates around the hexagon: flatter above and steep at the edge, with a fold along its middle."""
    rings = [_ring_of_shell(radius, 12) for radius in (0.56, 0.98, 1.12)]
    left, middle, right = ([ring[(2 * number + step) % 12] for ring in rings] for step in (0, 1, 2))
    middle[0] = (left[0] + right[0]) / 2  # the hexagon's side is straight
    points = _shrunk(np.array([left, middle, right]).reshape(-1, 3), 0.93).reshape(3, 3, 3)
    quads = [
        [points[side, step], points[side, step + 1], points[side + 1, step + 1], points[side + 1, step]]
        for side in (0, 1)
        for step in (0, 1)
    ]
    return joined([polygon(quad, SHELL) for quad in quads])


def _ring_of_shell(radius: float, sides: int, lift: float = 0.0) -> np.ndarray:
    """Points on the dome, `radius` times as far from its middle as the plates' edge in the plots."""
    height = EDGE - 0.02 + (TOP - EDGE) * math.sqrt(max(0.0, 1 - (radius / 1.16) ** 2)) + lift
    return ring((BACK[0], 0, height), radius * BACK[2] / 2, radius * BACK[3] / 2, sides)


def _shrunk(points: np.ndarray, by: float = 0.9) -> np.ndarray:
    middle = points.mean(axis=0)
    return middle + by * (points - middle)


def _head() -> Mesh:
    x, _, width, height, _ = HEAD
    skull = ellipsoid((width / 2, height / 2, 0.098), SKIN, sides=10, levels=6).moved(placed(x + 0.01, 0, 0.185))
    neck = loft([_collar(0.24, 0.075, 0.12), _collar(0.37, 0.065, 0.165)], SKIN)
    eye = ellipsoid((0.026, 0.022, 0.028), OUTLINE, sides=6, levels=4).moved(placed(x + 0.075, 0.073, 0.215))
    return joined([skull, neck, eye, eye.mirrored()])


def _collar(x: float, radius: float, height: float) -> np.ndarray:
    turns = np.arange(8) * math.tau / 8
    return np.column_stack([np.full(8, x), radius * np.cos(turns), height + radius * np.sin(turns)])


def _tail() -> Mesh:
    (root, half, *_), (tip, *_), _ = ((*corner, 0.0) for corner in TAIL)
    around = np.array([[root, -half, 0.10], [root, 0.0, 0.075], [root, half, 0.10], [root, 0.0, 0.145]])
    return loft([np.tile([tip, 0.0, 0.07], (4, 1)), around], SKIN)
