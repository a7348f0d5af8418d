"""A turtle's poses as a track: where it jumped, how far it drove, and which points are enough to draw it."""

from __future__ import annotations

import math

import numpy as np

WORLD = 11.088889
"""Side of turtlesim's square world in metres: 499 pixels at its 45 pixels a metre."""

SLACK = 0.05
"""A step longer than the speed explains by this much (m) is a jump: the turtle was put somewhere else."""


def find_jumps(poses: np.ndarray) -> np.ndarray:
    """Return the indices of the poses that the turtle cannot have driven to: teleport or reset.

    `poses` has the fields `stamp` (ns), `x`, `y` (m) and `speed` (m/s).
    """
    steps = _steps(poses)
    fastest = np.maximum(np.abs(poses["speed"][1:]), np.abs(poses["speed"][:-1]))
    possible = fastest * np.diff(poses["stamp"]) / 1e9
    return np.flatnonzero(steps > 1.5 * possible + SLACK) + 1


def distance_driven(poses: np.ndarray, jumps: np.ndarray) -> float:
    """Return the length of the track in metres, jumps left out."""
    steps = _steps(poses)
    steps[jumps - 1] = 0.0
    return math.fsum(steps)


def thinned(poses: np.ndarray, jumps: np.ndarray, spacing: float = 0.03) -> np.ndarray:
    """Return indices of poses about `spacing` metres apart, with both sides of each jump and both ends."""
    way = np.concatenate([[0.0], np.cumsum(_steps(poses))])
    fresh = np.flatnonzero(np.diff(np.floor(way / spacing))) + 1
    return np.unique(np.concatenate([[0, len(poses) - 1], fresh, jumps, jumps - 1]).astype(int))


def _steps(poses: np.ndarray) -> np.ndarray:
    return np.hypot(np.diff(poses["x"]), np.diff(poses["y"]))
