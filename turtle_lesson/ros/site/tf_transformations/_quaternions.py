"""Quaternions (x, y, z, w)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from ._vectors import unit_vector

Numbers = tuple[float, float, float, float]
EPSILON = float(np.finfo(float).eps) * 4.0


def _four(quaternion: Any) -> Numbers:
    if hasattr(quaternion, "w") and hasattr(quaternion, "x"):
        kind = type(quaternion).__name__
        raise TypeError(f"a quaternion is a list [x, y, z, w] here, got a {kind}: write [q.x, q.y, q.z, q.w]")
    x, y, z, w = map(float, quaternion)
    return x, y, z, w


def quaternion_about_axis(angle: float, axis: Any) -> Numbers:
    """The turn by an angle about an axis of any length."""
    x, y, z = (float(part) for part in unit_vector(axis) * math.sin(angle / 2.0))
    return x, y, z, math.cos(angle / 2.0)


def quaternion_multiply(quaternion1: Any, quaternion0: Any) -> Numbers:
    """The turn by `quaternion0`, then by `quaternion1`."""
    ax, ay, az, aw = _four(quaternion1)
    bx, by, bz, bw = _four(quaternion0)
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def quaternion_conjugate(quaternion: Any) -> npt.NDArray[np.float64]:
    """With the signs of x, y and z changed: for one of length 1 the turn back."""
    x, y, z, w = _four(quaternion)
    return np.array((-x, -y, -z, w))


def quaternion_inverse(quaternion: Any) -> npt.NDArray[np.float64]:
    """The turn back."""
    numbers = np.array(_four(quaternion))
    return quaternion_conjugate(numbers) / np.dot(numbers, numbers)


def quaternion_matrix(quaternion: Any) -> npt.NDArray[np.float64]:
    """The turn as a 4 × 4 matrix; a quaternion of any length counts as if it had length 1."""
    x, y, z, w = _four(quaternion)
    length = x * x + y * y + z * z + w * w
    matrix = np.identity(4)
    if length < EPSILON:
        return matrix
    vector = np.array((x, y, z))
    cross = np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))
    matrix[:3, :3] += 2.0 / length * (w * cross + np.outer(vector, vector) - np.dot(vector, vector) * np.identity(3))
    return matrix


def quaternion_from_matrix(matrix: Any) -> Numbers:
    """The turn in a matrix, with w not negative."""
    turn = np.array(matrix, dtype=np.float64)[:3, :3]
    turn = turn / np.linalg.norm(turn, axis=0)
    trace = float(np.trace(turn))
    diagonal = (*np.diag(turn), trace)
    largest = int(np.argmax(diagonal))
    if largest == 3:
        parts = [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1], 1.0 + trace]
    else:
        i, j, k = largest, (largest + 1) % 3, (largest + 2) % 3
        parts = [0.0, 0.0, 0.0, turn[k, j] - turn[j, k]]
        parts[i] = 1.0 + turn[i, i] - turn[j, j] - turn[k, k]
        parts[j], parts[k] = turn[j, i] + turn[i, j], turn[k, i] + turn[i, k]
    unit = unit_vector(parts)
    x, y, z, w = (float(part) for part in (-unit if unit[3] < 0.0 else unit))
    return x, y, z, w


def quaternion_slerp(quat0: Any, quat1: Any, fraction: float, spin: int = 0, shortestpath: bool = True) -> Any:
    """The turn at a fraction of the way between two, at an even speed, with `spin` half turns more."""
    start, end = unit_vector(_four(quat0)), unit_vector(_four(quat1))
    if fraction in (0.0, 1.0):
        return end if fraction else start
    likeness = float(np.dot(start, end))
    if abs(abs(likeness) - 1.0) < EPSILON:
        return start
    if shortestpath and likeness < 0.0:
        likeness, end = -likeness, -end
    angle = math.acos(likeness) + spin * math.pi
    if abs(angle) < EPSILON:
        return start
    return (math.sin((1.0 - fraction) * angle) * start + math.sin(fraction * angle) * end) / math.sin(angle)


def random_quaternion(rand: Any = None) -> npt.NDArray[np.float64]:
    """A random turn, all equally likely; `rand`: three random numbers from 0 to 1."""
    a, b, c = np.random.random(3) if rand is None else rand
    one, two = 2.0 * math.pi * b, 2.0 * math.pi * c
    near, far = math.sqrt(1.0 - a), math.sqrt(a)
    return np.array((math.sin(one) * near, math.cos(one) * near, math.sin(two) * far, math.cos(two) * far))


def random_rotation_matrix(rand: Any = None) -> npt.NDArray[np.float64]:
    """A random turn as a matrix."""
    return quaternion_matrix(random_quaternion(rand))
