"""Angles, quaternions (x, y, z, w) and 4 × 4 matrices, as the package tf_transformations has them: what programs use.

Names and arguments are those of https://github.com/DLu/tf_transformations. Angles are in rad.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import reduce

import numpy as np
import numpy.typing as npt
from tf2_py import _rotation as turns

# Three angles about three axes, in 12 ways: `sxyz` is roll, pitch, yaw about fixed axes; `rzyx` about turning ones.
# The letters name the axes in the order of the angles; `s` means axes that stay, `r` axes that are turned along.

Angles = tuple[float, float, float]
Numbers = tuple[float, float, float, float]
Matrix = npt.NDArray[np.float64]
EPSILON = float(np.finfo(float).eps) * 4.0


def _axes(axes: str) -> tuple[bool, tuple[int, ...]]:
    """Whether the axes turn along, and which they are."""
    kind, letters = axes[:1], axes[1:]
    if kind not in ("s", "r") or sorted(letters) != ["x", "y", "z"]:
        raise ValueError(f"axes must be such as 'sxyz' or 'rzyx', with each axis once, got {axes!r}")
    return kind == "r", tuple(map("xyz".index, letters))


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Numbers:
    """The quaternion of three angles: by default roll, pitch and yaw."""
    turning, numbers = _axes(axes)
    found: Numbers = (0.0, 0.0, 0.0, 1.0)
    for angle, axis in zip((ai, aj, ak), numbers, strict=True):
        turn = quaternion_about_axis(angle, np.identity(3)[axis])
        found = quaternion_multiply(found, turn) if turning else quaternion_multiply(turn, found)
    return found


def euler_matrix(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Matrix:
    """The 4 × 4 matrix of three angles: by default roll, pitch and yaw."""
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def euler_from_quaternion(quaternion: Iterable[float], axes: str = "sxyz") -> Angles:
    """The angles of a quaternion [x, y, z, w]: by default roll, pitch and yaw."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def euler_from_matrix(matrix: npt.ArrayLike, axes: str = "sxyz") -> Angles:
    """The angles of a turn in a matrix. Where many would do, the one about the last fixed axis is 0."""
    turning, numbers = _axes(axes)
    turn = np.array(matrix, dtype=np.float64)[:3, :3]
    # Fixed axes one after the other are the same as turning ones the other way round.
    a, b, c = numbers if turning else numbers[::-1]
    sign = 1.0 if (b - a) % 3 == 1 else -1.0
    cosine = math.hypot(turn[a, a], turn[a, b])
    first, middle, last = 0.0, math.atan2(sign * turn[a, c], cosine), math.atan2(sign * turn[b, a], turn[b, b])
    if cosine >= EPSILON:
        first, last = math.atan2(-sign * turn[b, c], turn[c, c]), math.atan2(-sign * turn[a, b], turn[a, a])
    return (first, middle, last) if turning else (last, middle, first)


def translation_matrix(direction: npt.ArrayLike) -> Matrix:
    """The matrix that shifts by a vector."""
    matrix = np.identity(4)
    matrix[:3, 3] = np.asarray(direction, dtype=np.float64)[:3]
    return matrix


def translation_from_matrix(matrix: npt.ArrayLike) -> Matrix:
    """The shift in a matrix."""
    return np.array(matrix, dtype=np.float64)[:3, 3]


def rotation_matrix(angle: float, direction: npt.ArrayLike, point: npt.ArrayLike | None = None) -> Matrix:
    """The matrix that turns by an angle about an axis, through a point if one is given."""
    matrix = quaternion_matrix(quaternion_about_axis(angle, np.asarray(direction, dtype=np.float64)[:3]))
    if point is not None:
        fixed = np.asarray(point, dtype=np.float64)[:3]
        matrix[:3, 3] = fixed - matrix[:3, :3] @ fixed
    return matrix


def inverse_matrix(matrix: npt.ArrayLike) -> Matrix:
    """The matrix that takes back what another does."""
    return np.linalg.inv(np.asarray(matrix, dtype=np.float64))


def concatenate_matrices(*matrices: npt.ArrayLike) -> Matrix:
    """The product of matrices: the last one is applied first."""
    return reduce(np.matmul, matrices, np.identity(4))


def _four(quaternion: Iterable[float]) -> Numbers:
    if hasattr(quaternion, "w") and hasattr(quaternion, "x"):
        kind = type(quaternion).__name__
        raise TypeError(f"a quaternion is a list [x, y, z, w] here, got a {kind}: write [q.x, q.y, q.z, q.w]")
    x, y, z, w = map(float, quaternion)
    return x, y, z, w


def quaternion_about_axis(angle: float, axis: npt.ArrayLike) -> Numbers:
    """The turn by an angle about an axis of any length."""
    x, y, z = (float(part) for part in unit_vector(axis) * math.sin(angle / 2.0))
    return x, y, z, math.cos(angle / 2.0)


def quaternion_multiply(quaternion1: Iterable[float], quaternion0: Iterable[float]) -> Numbers:
    """The turn by `quaternion0`, then by `quaternion1`."""
    return turns.multiply(_four(quaternion1), _four(quaternion0))


def quaternion_conjugate(quaternion: Iterable[float]) -> Matrix:
    """With the signs of x, y and z changed: for one of length 1 the turn back."""
    x, y, z, w = _four(quaternion)
    return np.array((-x, -y, -z, w))


def quaternion_inverse(quaternion: Iterable[float]) -> Matrix:
    """The turn back."""
    numbers = np.array(_four(quaternion))
    return quaternion_conjugate(numbers) / np.dot(numbers, numbers)


def quaternion_matrix(quaternion: Iterable[float]) -> Matrix:
    """The turn as a 4 × 4 matrix; a quaternion of any length counts as if it had length 1."""
    numbers = _four(quaternion)
    matrix = np.identity(4)
    if np.dot(numbers, numbers) >= EPSILON:
        matrix[:3, :3] = turns.matrix_of(numbers)
    return matrix


def quaternion_from_matrix(matrix: npt.ArrayLike) -> Numbers:
    """The turn in a matrix, with w not negative."""
    turn = np.array(matrix, dtype=np.float64)[:3, :3]
    parts = unit_vector(turns.turn_of((turn / np.linalg.norm(turn, axis=0)).tolist()))
    x, y, z, w = (float(part) for part in parts)
    return (-x, -y, -z, -w) if w < 0.0 else (x, y, z, w)


def quaternion_slerp(quat0: npt.ArrayLike, quat1: npt.ArrayLike, fraction: float) -> Matrix:
    """The turn at a fraction of the shorter way between two, at an even speed."""
    start, end = _four(unit_vector(quat0)), _four(unit_vector(quat1))
    return np.array(turns.slerp(start, end, fraction))


def unit_vector(data: npt.ArrayLike) -> Matrix:
    """The same vector with length 1."""
    vector = np.array(data, dtype=np.float64)
    return vector / np.linalg.norm(vector)
