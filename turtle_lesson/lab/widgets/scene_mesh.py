"""Shapes made of flat triangles, from which the 3-D scene and its picture are both drawn. Metres, z is up."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from ...turtlesim.obstacles import Circle, Obstacle
from .. import drawing
from ..drawing import BACK, BODY, HEAD, LEGS, OUTLINE, RIM, SHELL, SKIN, TAIL
from ..path import TOLERANCE
from ..recording import WORLD
from ..status_and_scan import Beams, reach_of


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


def joined(meshes: Iterable[Mesh]) -> Mesh:
    """Several meshes as one."""
    listed = list(meshes)
    return Mesh(np.concatenate([each.corners for each in listed]), np.concatenate([each.colours for each in listed]))


def triangles(corners: ArrayLike, colour: str) -> Mesh:
    """Triangles of one colour such as "#0072B2", from three points each."""
    points = np.asarray(corners, float).reshape(-1, 3, 3)
    return Mesh(points, np.tile([part / 255 for part in bytes.fromhex(colour[1:])], (len(points), 1)))


def polygon(points: ArrayLike, colour: str) -> Mesh:
    """A flat convex piece, seen from where its points go round counter-clockwise."""
    places = np.asarray(points, float)
    return triangles([[places[0], places[at], places[at + 1]] for at in range(1, len(places) - 1)], colour)


def lifted(flat: np.ndarray, height: float) -> np.ndarray:
    """Points on the floor (n by 2) at a height: n by 3."""
    return np.column_stack([flat, np.full(len(flat), height)])


def loft(rings: ArrayLike, colour: str) -> Mesh:
    """The skin between rings of equally many points, from the lowest to the highest."""
    pieces = []
    for low, high in pairwise(np.asarray(rings, float)):
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
    bottom, top = (lifted(np.asarray(outline, float), height) for height in (low, high))
    return joined([loft([bottom, top], colour), polygon(top, colour)])


def ellipsoid(radii: Sequence[float], colour: str, sides: int = 8, levels: int = 5) -> Mesh:
    """An ellipsoid about the origin, of few faces."""
    angles = np.linspace(-math.pi / 2, math.pi / 2, levels + 1)
    unit = [ring((0, 0, math.sin(each)), math.cos(each), math.cos(each), sides) for each in angles]
    return loft(np.array(unit) * radii, colour)


def placed(x: float = 0.0, y: float = 0.0, z: float = 0.0, turn: float = 0.0, size: float = 1.0) -> np.ndarray:
    """The 4 by 4 matrix that makes something `size` times as large, turns it about z (rad) and shifts it."""
    cos, sin = size * math.cos(turn), size * math.sin(turn)
    return np.array([[cos, -sin, 0, x], [sin, cos, 0, y], [0, 0, size, z], [0, 0, 0, 1.0]])


LENGTH = 0.95
"""From the turtle's nose to its tail, m. It has few flat faces, and from above it is the turtle of the plots. All that follows
is in parts of this length: it looks along +x, its middle is (0, 0)."""

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
    for name, hip, (foot_x, foot_y, width, height, turn) in zip(("front", "hind"), HIPS, LEGS, strict=True):
        foot = ellipsoid((width / 2, height / 2, 0.06), SKIN, sides=8, levels=4)
        there = placed(foot_x - hip[0], foot_y - hip[1], 0.062, math.radians(turn))
        left = foot.moved(there).moved(placed(size=LENGTH))
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
    collars = ((0.24, 0.075, 0.12), (0.37, 0.065, 0.165))  # upright rings: how far in front, radius, height
    neck = loft([ring((0, height, front), radius, radius, 8)[:, [2, 0, 1]] for front, radius, height in collars], SKIN)
    eye = ellipsoid((0.026, 0.022, 0.028), OUTLINE, sides=6, levels=4).moved(placed(x + 0.075, 0.073, 0.215))
    return joined([skull, neck, eye, eye.mirrored()])


def _tail() -> Mesh:
    (root, half, *_), (tip, *_), _ = ((*corner, 0.0) for corner in TAIL)
    around = np.array([[root, -half, 0.10], [root, 0.0, 0.075], [root, half, 0.10], [root, 0.0, 0.145]])
    return loft([np.tile([tip, 0.0, 0.07], (4, 1)), around], SKIN)


FLOOR, GRID, WALL = "#fbfbf8", "#dcdcd5", "#c9ced6"
"""On a light page; on a dark one the browser takes darker ones (js/scene_theme.js)."""
OBSTACLE, OBSTACLE_EDGE = "#eeb655", "#a86f00"
TRAIL, FREE, HIT, POLE = "#1f86c7", "#56b4e9", "#0072b2", "#8a9099"

WALL_HEIGHT, WALL_WIDTH = 0.22, 0.14
OBSTACLE_HEIGHT = 0.5
"""As the markers on /world/obstacles have it; the turtle's own world is flat."""
BEAM_HEIGHT = 0.12
"""Where the laser's fan lies, m: the turtle carries its laser below the shell's edge."""
SAME = 0.12
"""Neighbouring beams whose ranges differ by less than this part hit the same thing."""


def floor() -> Mesh:
    """The floor, a slab with its surface at height 0."""
    side, low = WORLD + 2 * WALL_WIDTH, -0.12
    outline = np.array([(0, 0), (side, 0), (side, side), (0, side)]) - WALL_WIDTH
    return prism(outline, low, 0.0, FLOOR)


def grid() -> Mesh:
    """Lines a metre apart, as narrow strips just above the floor."""
    half, height, strips = 0.012, 0.004, []
    for at in range(1, math.ceil(WORLD)):
        upright = [(at - half, 0), (at + half, 0), (at + half, WORLD), (at - half, WORLD)]
        level = [(0, at - half), (WORLD, at - half), (WORLD, at + half), (0, at + half)]
        strips += [polygon([(x, y, height) for x, y in line], GRID) for line in (upright, level)]
    return joined(strips)


def walls() -> list[Mesh]:
    """The four walls."""
    low, high = -WALL_WIDTH, WORLD + WALL_WIDTH
    boxes = [(low, low, high, 0), (low, WORLD, high, high), (low, 0, 0, WORLD), (WORLD, 0, high, WORLD)]
    return [
        prism([(left, below), (right, below), (right, above), (left, above)], 0.0, WALL_HEIGHT, WALL)
        for left, below, right, above in boxes
    ]


def outline(obstacle: Obstacle) -> np.ndarray:
    """The outline of an obstacle, from above: n by 2."""
    wide, high = obstacle.width / 2, obstacle.height / 2
    flat = np.array([(-wide, -high, 0.0), (wide, -high, 0.0), (wide, high, 0.0), (-wide, high, 0.0)])
    if isinstance(obstacle, Circle):
        flat = ring((0, 0, 0), wide, high, 36)
    matrix = placed(obstacle.x, obstacle.y, 0.0, obstacle.angle)
    return (flat @ matrix[:3, :3].T + matrix[:3, 3])[:, :2]


def ribbon(pieces: Iterable[np.ndarray], width: float = 0.07) -> Mesh:
    """Lines on the floor, each through points (n by 2) in their order: two triangles a step.

    A step is a little longer than from point to point, so that no gap opens at a corner.
    """
    steps = np.concatenate([np.empty((0, 2, 2)), *(np.stack([piece[:-1], piece[1:]], axis=1) for piece in pieces)])
    begins, ends = np.moveaxis(steps[(steps[:, 0] != steps[:, 1]).any(axis=1)], 1, 0)
    along = width / 2 * (ends - begins) / np.hypot(*(ends - begins).T)[:, None]
    across = along[:, ::-1] * (-1, 1)
    back, front = begins - 0.6 * along, ends + 0.6 * along
    corners = [lifted(flat, 0.012) for flat in (back - across, front - across, front + across, back + across)]
    return triangles(np.stack(corners, axis=1)[:, [0, 1, 2, 0, 2, 3]], TRAIL)


def fan(beams: Beams, x: float, y: float, theta: float) -> tuple[Mesh, Mesh]:
    """What the laser saw from a place: the space that is free, as far as there is a floor, and a mark for each hit."""
    reach = reach_of(beams)
    ends = np.where(beams.sees, np.minimum(beams.ranges, reach), reach)
    along, up = np.cos(beams.angles + theta), np.sin(beams.angles + theta)
    with np.errstate(divide="ignore", invalid="ignore"):  # how far each beam goes before it ends, or leaves the world
        to_side = np.maximum(-x / along, (WORLD - x) / along)
        to_end = np.maximum(-y / up, (WORLD - y) / up)
    far = np.maximum(np.fmin(np.fmin(to_side, to_end), ends), 0.0)
    rim = lifted(np.column_stack([x + far * along, y + far * up]), BEAM_HEIGHT)
    middle = np.full_like(rim[1:], (x, y, BEAM_HEIGHT))
    free = triangles(np.stack([middle, rim[:-1], rim[1:]], axis=1), FREE)
    return free, _marks(beams, ends).moved(placed(x, y, 0.0, theta))


def _marks(beams: Beams, ends: np.ndarray) -> Mesh:
    """An upright band along what the beams hit: joined where neighbours hit the same thing, a short piece elsewhere."""
    half = abs(beams.angles[1] - beams.angles[0]) / 2 if len(beams) > 1 else 0.01
    seen = np.flatnonzero(beams.sees)
    after = np.append(seen[1:], seen[-1:])
    alike = np.abs(ends[after] - ends[seen]) < SAME * np.maximum(1.0, ends[seen])
    goes_on = (after == seen + 1) & alike
    far, turn = ends[seen] - 0.02, beams.angles[seen]
    right = _polar(far, np.where(goes_on, turn, turn - half))
    left = _polar(np.where(goes_on, ends[after] - 0.02, far), np.where(goes_on, beams.angles[after], turn + half))
    low, high = 0.03, 0.2
    ends_up = [(right, low), (left, low), (left, high), (right, low), (left, high), (right, high)]
    return triangles(np.stack([lifted(flat, height) for flat, height in ends_up], axis=1), HIT)


def _polar(far: np.ndarray, turns: np.ndarray) -> np.ndarray:
    return np.column_stack([far * np.cos(turns), far * np.sin(turns)])


def goal_mark(x: float, y: float, theta: float) -> Mesh:
    """On the floor, the ring within which a goal counts as reached, and a pointer for the heading."""
    inner, outer = (ring((0, 0, 0.018), radius, radius, 32) for radius in (TOLERANCE - 0.035, TOLERANCE))
    arrow = [(TOLERANCE + 0.05, -0.13, 0.018), (TOLERANCE + 0.3, 0, 0.018), (TOLERANCE + 0.05, 0.13, 0.018)]
    mark = joined([loft([outer, inner], drawing.VERMILLION), polygon(arrow, drawing.VERMILLION)])
    return mark.moved(placed(x, y, 0.0, theta))


def goal_flag(x: float, y: float, reached: bool) -> Mesh:
    """The flag in the middle of the ring; beside it when the turtle stands there."""
    aside = (0.6 if y < WORLD - 0.8 else -0.6) if reached else 0.0
    foot, top = ring((0, 0, 0), 0.022, 0.022, 8), ring((0, 0, 1.12), 0.018, 0.018, 8)
    cloth = polygon([(0, 0, 0.76), (0.55, 0, 0.93), (0, 0, 1.1)], drawing.VERMILLION)
    return joined([loft([foot, top], POLE), polygon(top, POLE), cloth]).moved(placed(x, y + aside))
