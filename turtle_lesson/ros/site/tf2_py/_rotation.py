"""Vectors and unit quaternions as plain tuples, (x, y, z) and (x, y, z, w): quicker than numpy for so few numbers."""

from __future__ import annotations

import math

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Matrix = tuple[Vector, Vector, Vector]

NO_TURN: Quaternion = (0.0, 0.0, 0.0, 1.0)
ORIGIN: Vector = (0.0, 0.0, 0.0)


def multiply(left: Quaternion, right: Quaternion) -> Quaternion:
    """Turn by `right`, then by `left`."""
    ax, ay, az, aw = left
    bx, by, bz, bw = right
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def inverse(turn: Quaternion) -> Quaternion:
    """The turn back."""
    x, y, z, w = turn
    return (-x, -y, -z, w)


def rotate(turn: Quaternion, vector: Vector) -> Vector:
    """A vector, turned."""
    x, y, z, w = turn
    vx, vy, vz = vector
    tx, ty, tz = 2.0 * (y * vz - z * vy), 2.0 * (z * vx - x * vz), 2.0 * (x * vy - y * vx)
    return (
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )


def add(left: Vector, right: Vector) -> Vector:
    """The sum of two vectors."""
    return (left[0] + right[0], left[1] + right[1], left[2] + right[2])


def lerp(one: Vector, two: Vector, share: float) -> Vector:
    """The point at a share (0 to 1) of the way between two."""
    x, y, z = ((1.0 - share) * a + share * b for a, b in zip(one, two, strict=True))
    return x, y, z


def slerp(one: Quaternion, two: Quaternion, share: float) -> Quaternion:
    """The turn at a share (0 to 1) of the shorter way between two, at an even speed."""
    likeness = sum(a * b for a, b in zip(one, two, strict=True))
    if likeness < 0.0:
        two, likeness = (-two[0], -two[1], -two[2], -two[3]), -likeness
    angle = math.acos(min(1.0, likeness))
    if angle == 0.0:
        return one
    near, far = math.sin((1.0 - share) * angle) / math.sin(angle), math.sin(share * angle) / math.sin(angle)
    x, y, z, w = (near * a + far * b for a, b in zip(one, two, strict=True))
    return x, y, z, w


def matrix_of(turn: Quaternion) -> Matrix:
    """A turn as a matrix. A quaternion of any length counts as if its length were one; one of length zero gives NaN."""
    x, y, z, w = turn
    length = x * x + y * y + z * z + w * w
    s = 2.0 / length if length else math.nan
    return (
        (1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)),
        (s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x)),
        (s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y)),
    )


def turn_of(matrix: Matrix) -> Quaternion:
    """A matrix as a quaternion: with w > 0 where that is not small, else with its largest part positive."""
    trace = matrix[0][0] + matrix[1][1] + matrix[2][2]
    if trace > 0.0:
        root = math.sqrt(trace + 1.0)
        s = 0.5 / root
        return (
            (matrix[2][1] - matrix[1][2]) * s,
            (matrix[0][2] - matrix[2][0]) * s,
            (matrix[1][0] - matrix[0][1]) * s,
            0.5 * root,
        )
    i = max(range(3), key=lambda axis: matrix[axis][axis])
    j, k = (i + 1) % 3, (i + 2) % 3
    root = math.sqrt(matrix[i][i] - matrix[j][j] - matrix[k][k] + 1.0)
    s = 0.5 / root
    parts = [0.0, 0.0, 0.0, (matrix[k][j] - matrix[j][k]) * s]
    parts[i] = 0.5 * root
    parts[j] = (matrix[j][i] + matrix[i][j]) * s
    parts[k] = (matrix[k][i] + matrix[i][k]) * s
    return (parts[0], parts[1], parts[2], parts[3])


def canonical(turn: Quaternion) -> Quaternion:
    """The same turn as tf2 hands it out: it keeps turns as matrices, so that length and sign of a quaternion are lost."""
    return turn_of(matrix_of(turn))
