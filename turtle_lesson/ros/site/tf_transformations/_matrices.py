"""4 × 4 matrices that turn, shift and scale."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from ._angles import euler_from_matrix, euler_matrix
from ._quaternions import quaternion_about_axis, quaternion_from_matrix, quaternion_matrix
from ._vectors import unit_vector

Matrix = npt.NDArray[np.float64]


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
    return matrix if point is None else _about(matrix, point)


def _about(matrix: Matrix, point: Any) -> Matrix:
    """The same matrix with a point that stays where it is."""
    fixed = np.asarray(point, dtype=np.float64)[:3]
    matrix[:3, 3] = fixed - matrix[:3, :3] @ fixed
    return matrix


def rotation_from_matrix(matrix: Any) -> tuple[float, Matrix, Matrix]:
    """Angle, axis and a point of it, of a matrix that turns."""
    array = np.array(matrix, dtype=np.float64)
    x, y, z, w = quaternion_from_matrix(array)
    sine = math.sqrt(x * x + y * y + z * z)
    axis = np.array((x, y, z)) / sine if sine else np.array((1.0, 0.0, 0.0))
    # Points that stay: (1 - R) p = t, which has a line of solutions; the nearest to the origin is taken.
    nearest, *_ = np.linalg.lstsq(np.identity(3) - array[:3, :3], array[:3, 3], rcond=None)
    return 2.0 * math.atan2(sine, w), axis, np.append(nearest, 1.0)


def scale_matrix(factor: float, origin: Any = None, direction: Any = None) -> Matrix:
    """The matrix that scales by a factor from an origin on: all ways, or along a direction alone."""
    matrix = np.identity(4)
    if direction is None:
        matrix[:3, :3] *= factor
    else:
        along = unit_vector(np.asarray(direction, dtype=np.float64)[:3])
        matrix[:3, :3] -= (1.0 - factor) * np.outer(along, along)
    return matrix if origin is None else _about(matrix, origin)


def inverse_matrix(matrix: Any) -> Matrix:
    """The matrix that takes back what another does."""
    return np.linalg.inv(matrix)


def concatenate_matrices(*matrices: Any) -> Matrix:
    """The product of matrices: the last one is applied first."""
    product = np.identity(4)
    for matrix in matrices:
        product = product @ np.asarray(matrix, dtype=np.float64)
    return product


def is_same_transform(matrix0: Any, matrix1: Any) -> bool:
    """Whether two matrices do the same, up to rounding."""
    one, two = np.array(matrix0, dtype=np.float64), np.array(matrix1, dtype=np.float64)
    return bool(np.allclose(one / one[3, 3], two / two[3, 3]))


def compose_matrix(
    scale: Any = None, shear: Any = None, angles: Any = None, translate: Any = None, perspective: Any = None
) -> Matrix:
    """The matrix that scales, shears, turns (roll, pitch, yaw) and shifts, in this order; `perspective` is left out."""
    matrix = np.identity(4)
    shears = (0.0, 0.0, 0.0) if shear is None else shear
    matrix[0, 1], matrix[0, 2], matrix[1, 2] = shears
    matrix[:3, :3] = np.diag((1.0, 1.0, 1.0) if scale is None else tuple(scale)) @ matrix[:3, :3]
    turned = matrix if angles is None else euler_matrix(*angles) @ matrix
    return turned if translate is None else translation_matrix(translate) @ turned


def decompose_matrix(matrix: Any) -> tuple[Matrix, Matrix, tuple[float, float, float], Matrix, None]:
    """Scale, shear, angles (roll, pitch, yaw), shift and perspective (None) of a matrix: `compose_matrix` undone."""
    array = np.array(matrix, dtype=np.float64)
    turn, upper = np.linalg.qr(array[:3, :3])
    signs = np.where(np.diag(upper) < 0.0, -1.0, 1.0)
    turn, upper = turn * signs, upper * signs[:, None]
    if np.linalg.det(turn) < 0.0:
        turn, upper = turn * (-1.0, 1.0, 1.0), upper * np.array((-1.0, 1.0, 1.0))[:, None]
    scale = np.diag(upper).copy()
    shear = np.array((upper[0, 1] / scale[0], upper[0, 2] / scale[0], upper[1, 2] / scale[1]))
    return scale, shear, euler_from_matrix(turn), array[:3, 3], None
