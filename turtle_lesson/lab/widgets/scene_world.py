"""What stands in the 3-D scene beside the turtle, as meshes: floor, walls, obstacles, trail, laser and goals."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from .. import style
from ..beams import Beams
from ..fan import reach_of
from ..goals import TOLERANCE
from ..recording import Obstacle
from ..track import WORLD
from .scene_mesh import Mesh, joined, loft, placed, polygon, prism, ring, triangles

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


def outline(obstacle: Obstacle, sides: int = 36) -> np.ndarray:
    """The outline of an obstacle, from above: n by 2."""
    wide, high = obstacle.width / 2, obstacle.height / 2
    if obstacle.shape == "box":
        flat = np.array([(-wide, -high, 0.0), (wide, -high, 0.0), (wide, high, 0.0), (-wide, high, 0.0)])
    else:
        flat = ring((0, 0, 0), wide, high, sides)
    matrix = placed(obstacle.x, obstacle.y, 0.0, obstacle.angle)
    return (flat @ matrix[:3, :3].T + matrix[:3, 3])[:, :2]


def obstacle_mesh(obstacle: Obstacle) -> Mesh:
    """An obstacle as a block on the floor."""
    return prism(outline(obstacle), 0.0, OBSTACLE_HEIGHT, OBSTACLE)


def ribbon(pieces: Sequence[np.ndarray], width: float = 0.07, height: float = 0.012) -> Mesh:
    """Lines on the floor, each through points (n by 2) in their order: two triangles a step."""
    quads = [_quads(np.asarray(piece, float), width / 2) for piece in pieces if len(piece) > 1]
    if not quads:
        return joined([])
    flat = np.concatenate(quads)
    corners = np.concatenate([flat, np.full((*flat.shape[:2], 1), height)], axis=2)
    return triangles(corners[:, [0, 1, 2, 0, 2, 3]], TRAIL)


def _quads(points: np.ndarray, half: float) -> np.ndarray:
    """A quad for each step, a little longer than the step, so that no gap opens at a corner."""
    steps = np.diff(points, axis=0)
    lengths = np.hypot(*steps.T)
    steps, begins = steps[lengths > 0], points[:-1][lengths > 0]
    ends = begins + steps
    along = half * steps / lengths[lengths > 0][:, None]
    across = np.column_stack([-along[:, 1], along[:, 0]])
    back, front = begins - 0.6 * along, ends + 0.6 * along
    return np.stack([back - across, front - across, front + across, back + across], axis=1)


def fan(beams: Beams, x: float, y: float, theta: float) -> tuple[Mesh, Mesh]:
    """What the laser saw from a place: the space that is free, as far as there is a floor, and a mark for each hit."""
    reach = reach_of(beams)
    ends = np.where(beams.sees, np.minimum(beams.ranges, reach), reach)
    turns = beams.angles + theta
    far = _to_edge(x, y, turns, ends)
    flat = np.column_stack([x + far * np.cos(turns), y + far * np.sin(turns)])
    rim = np.column_stack([flat, np.full(len(flat), BEAM_HEIGHT)])
    middle = np.tile([x, y, BEAM_HEIGHT], (max(len(rim) - 1, 0), 1))
    free = triangles(np.stack([middle, rim[:-1], rim[1:]], axis=1), FREE)
    return free, _marks(beams, ends).moved(placed(x, y, 0.0, theta))


def _to_edge(x: float, y: float, turns: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """How far each beam goes before it ends, or leaves the world."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ways = [
            np.maximum(-place / along, (WORLD - place) / along)
            for place, along in ((x, np.cos(turns)), (y, np.sin(turns)))
        ]
    return np.maximum(np.fmin(np.fmin(*ways), ends), 0.0)


def _marks(beams: Beams, ends: np.ndarray, low: float = 0.03, high: float = 0.2) -> Mesh:
    """An upright band along what the beams hit: joined where neighbours hit the same thing, a short piece elsewhere."""
    half = abs(beams.angles[1] - beams.angles[0]) / 2 if len(beams) > 1 else 0.01
    seen = np.flatnonzero(beams.sees)
    bands = []
    for number, beam in enumerate(seen):
        after = seen[number + 1] if number + 1 < len(seen) else -1
        far, turn = ends[beam] - 0.02, beams.angles[beam]
        if after == beam + 1 and abs(ends[after] - ends[beam]) < SAME * max(1.0, ends[beam]):
            bands.append((far, turn, ends[after] - 0.02, beams.angles[after]))
        else:
            bands.append((far, turn - half, far, turn + half))
    if not bands:
        return joined([])
    first_far, first_turn, last_far, last_turn = np.array(bands).T
    right = np.column_stack([first_far * np.cos(first_turn), first_far * np.sin(first_turn)])
    left = np.column_stack([last_far * np.cos(last_turn), last_far * np.sin(last_turn)])
    ends_up = [(right, low), (left, low), (left, high), (right, low), (left, high), (right, high)]
    corners = [np.column_stack([flat, np.full(len(flat), height)]) for flat, height in ends_up]
    return triangles(np.stack(corners, axis=1), HIT)


def goal_mark(x: float, y: float, theta: float) -> Mesh:
    """On the floor, the ring within which a goal counts as reached, and a pointer for the heading."""
    inner, outer = (ring((0, 0, 0.018), radius, radius, 32) for radius in (TOLERANCE - 0.035, TOLERANCE))
    arrow = [(TOLERANCE + 0.05, -0.13, 0.018), (TOLERANCE + 0.3, 0, 0.018), (TOLERANCE + 0.05, 0.13, 0.018)]
    return joined([loft([outer, inner], style.VERMILLION), polygon(arrow, style.VERMILLION)]).moved(
        placed(x, y, 0.0, theta)
    )


def goal_flag(x: float, y: float, reached: bool) -> Mesh:
    """The flag in the middle of the ring; beside it when the turtle stands there."""
    aside = (0.6 if y < WORLD - 0.8 else -0.6) if reached else 0.0
    return joined([_pole(), _pennant()]).moved(placed(x, y + aside))


def _pole() -> Mesh:
    foot, top = ring((0, 0, 0), 0.022, 0.022, 8), ring((0, 0, 1.12), 0.018, 0.018, 8)
    return joined([loft([foot, top], POLE), polygon(top, POLE)])


def _pennant() -> Mesh:
    """The cloth, in gentle waves, the same from both sides."""
    along = np.linspace(0.0, 0.55, 6)
    wave = 0.045 * np.sin(along / 0.55 * 1.5 * math.pi)
    drop = 0.17 * (1 - along / 0.55)
    upper = np.column_stack([along, wave, 0.93 + drop])
    lower = np.column_stack([along, wave, 0.93 - drop])
    corners = [[lower[at], lower[at + 1], upper[at + 1], upper[at]] for at in range(len(along) - 1)]
    return joined(polygon(each, style.VERMILLION) for each in corners)
