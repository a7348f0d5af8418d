"""Three angles about three axes, in 24 ways: `sxyz` is roll, pitch, yaw about fixed axes; `rzyx` about turning ones.

The letters name the axes in the order of the angles; `s` means axes that stay, `r` axes that are turned along.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from ._quaternions import EPSILON, Numbers, quaternion_about_axis, quaternion_matrix, quaternion_multiply

Angles = tuple[float, float, float]
_LETTERS = "xyz"


def _axes(axes: Any) -> tuple[bool, tuple[int, int, int]]:
    """Whether the axes turn along, and which they are. `axes`: such as "sxyz", or the code (0, 0, 0, 0) for it."""
    if not isinstance(axes, str):
        first, parity, repeated, turning = axes
        second = (first + 1 + parity) % 3
        third = first if repeated else 3 - first - second
        fixed = (first, second, third)
        return bool(turning), fixed[::-1] if turning else fixed
    numbers = tuple(_LETTERS.find(letter) for letter in axes[1:])
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


def euler_matrix(ai: float, aj: float, ak: float, axes: Any = "sxyz") -> npt.NDArray[np.float64]:
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


def _turning_angles(turn: npt.NDArray[np.float64], axes: tuple[int, ...]) -> Angles:
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


def _with_repeated_axis(turn: npt.NDArray[np.float64], a: int, b: int) -> Angles:
    other = 3 - a - b
    sign = 1.0 if (b - a) % 3 == 1 else -1.0
    sine = math.hypot(turn[a, b], turn[a, other])
    middle = math.atan2(sine, turn[a, a])
    if sine < EPSILON:
        return 0.0, middle, math.atan2(-sign * turn[b, other], turn[b, b])
    first = math.atan2(turn[b, a], -sign * turn[other, a])
    return first, middle, math.atan2(turn[a, b], sign * turn[a, other])
