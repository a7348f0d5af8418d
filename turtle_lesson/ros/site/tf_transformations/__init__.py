"""Angles, quaternions (x, y, z, w) and 4 × 4 matrices, as the package tf_transformations has them: what programs use.

Names and arguments are those of https://github.com/DLu/tf_transformations. Angles are in rad.
"""

from __future__ import annotations

from typing import Any

from ._angles import euler_from_matrix, euler_from_quaternion, euler_matrix, quaternion_from_euler
from ._matrices import (
    compose_matrix,
    concatenate_matrices,
    decompose_matrix,
    identity_matrix,
    inverse_matrix,
    is_same_transform,
    rotation_from_matrix,
    rotation_matrix,
    scale_matrix,
    translation_from_matrix,
    translation_matrix,
)
from ._quaternions import (
    quaternion_about_axis,
    quaternion_conjugate,
    quaternion_from_matrix,
    quaternion_inverse,
    quaternion_matrix,
    quaternion_multiply,
    quaternion_slerp,
    random_quaternion,
    random_rotation_matrix,
)
from ._vectors import random_vector, unit_vector, vector_norm

__all__ = [
    "compose_matrix",
    "concatenate_matrices",
    "decompose_matrix",
    "euler_from_matrix",
    "euler_from_quaternion",
    "euler_matrix",
    "identity_matrix",
    "inverse_matrix",
    "is_same_transform",
    "quaternion_about_axis",
    "quaternion_conjugate",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_inverse",
    "quaternion_matrix",
    "quaternion_multiply",
    "quaternion_slerp",
    "random_quaternion",
    "random_rotation_matrix",
    "random_vector",
    "rotation_from_matrix",
    "rotation_matrix",
    "scale_matrix",
    "translation_from_matrix",
    "translation_matrix",
    "unit_vector",
    "vector_norm",
]

_OTHERS = """
    Arcball arcball_constrain_to_axis arcball_map_to_sphere arcball_nearest_axis clip_matrix orthogonalization_matrix
    projection_from_matrix projection_matrix reflection_from_matrix reflection_matrix scale_from_matrix
    shear_from_matrix shear_matrix superimposition_matrix
"""


def __getattr__(name: str) -> Any:
    if name in _OTHERS.split():
        raise AttributeError(
            f"tf_transformations.{name} is not available here; a real ROS 2 has it, and "
            "numpy can do the same with the 4 × 4 matrix"
        )
    raise AttributeError(f"module 'tf_transformations' has no attribute {name!r}")
