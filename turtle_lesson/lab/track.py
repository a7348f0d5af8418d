"""A turtle's poses as a track: where it jumped, how far it drove, and which points are enough to draw it."""

from __future__ import annotations

import math

import numpy as np

WORLD = 11.088889
"""Side of turtlesim's square world in metres: 499 pixels at its 45 pixels a metre."""

TICK = 16_000_000
"""How often, in ns, turtlesim publishes a pose."""

LATEST = 1_000_000_000
"""How late, in ns, a pose is expected to come at most: what a busy kernel may take for something else."""

SLACK = 0.05
"""A step longer than the speed explains by this much (m) is a jump: the turtle was put somewhere else."""


def find_jumps(poses: np.ndarray) -> np.ndarray:
    """Return the indices of the poses that the turtle cannot have driven to: teleport or reset.

    `poses` has the fields `stamp` (ns), `x`, `y` (m) and `speed` (m/s). A stamp may be the time at which a pose was heard:
    on a robot a busy kernel takes poses in bursts, each at least one tick of the simulator younger than the one before.
    """
    steps, stamps = _steps(poses), poses["stamp"]
    fastest = np.maximum(np.abs(poses["speed"][1:]), np.abs(poses["speed"][:-1]))
    behind = stamps - TICK * np.arange(len(poses))
    late = np.minimum(behind - np.minimum.accumulate(behind), LATEST)  # how long ago a pose may have been sent
    possible = fastest * (np.maximum(np.diff(stamps), TICK) + late[:-1]) / 1e9
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
