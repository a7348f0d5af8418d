"""Angles, quaternions (x, y, z, w) and 4 × 4 matrices, as the package tf_transformations has them: what programs use.

Names and arguments are those of https://github.com/DLu/tf_transformations. Angles are in rad.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
from tf2_py import _rotation as turns

_OTHERS = """
    Arcball arcball_constrain_to_axis arcball_map_to_sphere arcball_nearest_axis clip_matrix compose_matrix
    decompose_matrix is_same_transform orthogonalization_matrix projection_from_matrix projection_matrix
    random_quaternion random_rotation_matrix random_vector reflection_from_matrix reflection_matrix
    rotation_from_matrix scale_from_matrix scale_matrix shear_from_matrix shear_matrix superimposition_matrix
"""


def __getattr__(name: str) -> Any:
    text = f"module 'tf_transformations' has no attribute {name!r}"
    if name in _OTHERS.split():
        text = (
            f"tf_transformations.{name} is not available here; a real ROS 2 has it, and numpy can do the same with the "
            "4 × 4 matrix"
        )
    raise AttributeError(text)


# Three angles about three axes, in 24 ways: `sxyz` is roll, pitch, yaw about fixed axes; `rzyx` about turning ones.
# The letters name the axes in the order of the angles; `s` means axes that stay, `r` axes that are turned along.

Angles = tuple[float, float, float]
Numbers = tuple[float, float, float, float]
Matrix = npt.NDArray[np.float64]
EPSILON = float(np.finfo(float).eps) * 4.0


def _axes(axes: Any) -> tuple[bool, tuple[int, int, int]]:
    """Whether the axes turn along, and which they are. `axes`: such as "sxyz", or the code (0, 0, 0, 0) for it."""
    if not isinstance(axes, str):
        first, parity, repeated, turning = axes
        second = (first + 1 + parity) % 3
        third = first if repeated else 3 - first - second
        fixed = (first, second, third)
        return bool(turning), fixed[::-1] if turning else fixed
    numbers = tuple("xyz".find(letter) for letter in axes[1:])
    if len(axes) != 4 or axes[0] not in "sr" or -1 in numbers or numbers[1] in (numbers[0], numbers[2]):
        raise ValueError(f"axes must be such as 'sxyz' or 'rzyx', got {axes!r}")
    return axes[0] == "r", (numbers[0], numbers[1], numbers[2])


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: Any = "sxyz") -> Numbers:
    """The quaternion of three angles: by default roll, pitch and yaw."""
    turning, numbers = _axes(axes)
    found: Numbers = (0.0, 0.0, 0.0, 1.0)
    for angle, axis in zip((ai, aj, ak), numbers, strict=True):
        turn = quaternion_about_axis(angle, np.identity(3)[axis])
        found = quaternion_multiply(found, turn) if turning else quaternion_multiply(turn, found)
    return found


def euler_matrix(ai: float, aj: float, ak: float, axes: Any = "sxyz") -> Matrix:
    """The 4 × 4 matrix of three angles: by default roll, pitch and yaw."""
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def euler_from_quaternion(quaternion: Any, axes: Any = "sxyz") -> Angles:
    """The angles of a quaternion [x, y, z, w]: by default roll, pitch and yaw."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def euler_from_matrix(matrix: Any, axes: Any = "sxyz") -> Angles:
    """The angles of a turn in a matrix. Where many would do, the one about the last fixed axis is 0."""
    turning, numbers = _axes(axes)
    turn = np.array(matrix, dtype=np.float64)[:3, :3]
    # Fixed axes one after the other are the same as turning ones the other way round.
    angles = _turning_angles(turn, numbers if turning else numbers[::-1])
    return angles if turning else angles[::-1]


def _turning_angles(turn: Matrix, axes: tuple[int, ...]) -> Angles:
    a, b, c = axes
    if a == c:
        return _with_repeated_axis(turn, a, b)
    sign = 1.0 if (b - a) % 3 == 1 else -1.0
    cosine = math.hypot(turn[a, a], turn[a, b])
    middle = math.atan2(sign * turn[a, c], cosine)
    if cosine < EPSILON:
        return 0.0, middle, math.atan2(sign * turn[b, a], turn[b, b])
    first = math.atan2(-sign * turn[b, c], turn[c, c])
    return first, middle, math.atan2(-sign * turn[a, b], turn[a, a])


def _with_repeated_axis(turn: Matrix, a: int, b: int) -> Angles:
    other = 3 - a - b
    sign = 1.0 if (b - a) % 3 == 1 else -1.0
    sine = math.hypot(turn[a, b], turn[a, other])
    middle = math.atan2(sine, turn[a, a])
    if sine < EPSILON:
        return 0.0, middle, math.atan2(-sign * turn[b, other], turn[b, b])
    first = math.atan2(turn[b, a], -sign * turn[other, a])
    return first, middle, math.atan2(turn[a, b], sign * turn[a, other])


def identity_matrix() -> Matrix:
    """The matrix that changes nothing."""
    return np.identity(4)


def translation_matrix(direction: Any) -> Matrix:
    """The matrix that shifts by a vector."""
    matrix = np.identity(4)
    matrix[:3, 3] = np.asarray(direction, dtype=np.float64)[:3]
    return matrix


def translation_from_matrix(matrix: Any) -> Matrix:
    """The shift in a matrix."""
    return np.array(matrix, dtype=np.float64)[:3, 3]


def rotation_matrix(angle: float, direction: Any, point: Any = None) -> Matrix:
    """The matrix that turns by an angle about an axis, through a point if one is given."""
    matrix = quaternion_matrix(quaternion_about_axis(angle, np.asarray(direction, dtype=np.float64)[:3]))
    if point is not None:
        fixed = np.asarray(point, dtype=np.float64)[:3]
        matrix[:3, 3] = fixed - matrix[:3, :3] @ fixed
    return matrix


def inverse_matrix(matrix: Any) -> Matrix:
    """The matrix that takes back what another does."""
    return np.linalg.inv(matrix)


def concatenate_matrices(*matrices: Any) -> Matrix:
    """The product of matrices: the last one is applied first."""
    product = np.identity(4)
    for matrix in matrices:
        product = product @ np.asarray(matrix, dtype=np.float64)
    return product


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
    return turns.multiply(_four(quaternion1), _four(quaternion0))


def quaternion_conjugate(quaternion: Any) -> Matrix:
    """With the signs of x, y and z changed: for one of length 1 the turn back."""
    x, y, z, w = _four(quaternion)
    return np.array((-x, -y, -z, w))


def quaternion_inverse(quaternion: Any) -> Matrix:
    """The turn back."""
    numbers = np.array(_four(quaternion))
    return quaternion_conjugate(numbers) / np.dot(numbers, numbers)


def quaternion_matrix(quaternion: Any) -> Matrix:
    """The turn as a 4 × 4 matrix; a quaternion of any length counts as if it had length 1."""
    numbers = _four(quaternion)
    matrix = np.identity(4)
    if np.dot(numbers, numbers) >= EPSILON:
        matrix[:3, :3] = turns.matrix_of(numbers)
    return matrix


def quaternion_from_matrix(matrix: Any) -> Numbers:
    """The turn in a matrix, with w not negative."""
    turn = np.array(matrix, dtype=np.float64)[:3, :3]
    parts = unit_vector(turns.turn_of((turn / np.linalg.norm(turn, axis=0)).tolist()))
    x, y, z, w = (float(part) for part in parts)
    return (-x, -y, -z, -w) if w < 0.0 else (x, y, z, w)


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


def vector_norm(data: Any, axis: int | None = None, out: Any = None) -> Any:
    """The length of a vector, or of the vectors along an axis; goes into `out` if that is given."""
    lengths = np.sqrt(np.sum(np.square(np.asarray(data, dtype=np.float64)), axis=axis))
    if out is not None:
        out[...] = lengths
        return None
    return float(lengths) if np.ndim(data) == 1 else np.atleast_1d(lengths)


def unit_vector(data: Any, axis: int | None = None, out: Any = None) -> Any:
    """The same vector, or vectors along an axis, with length 1; goes into `out` if that is given."""
    array = np.array(data, dtype=np.float64)
    lengths = np.sqrt(np.sum(array * array, axis=axis, keepdims=axis is not None))
    result = array / lengths if array.size else array
    if out is not None:
        out[...] = result
        return None
    return result
