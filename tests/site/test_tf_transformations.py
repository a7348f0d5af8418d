"""Angles, quaternions and matrices: the figures of the package's own examples, and what must hold for all figures."""

from __future__ import annotations

import math

import numpy as np
import pytest
import tf_transformations as tft
from geometry_msgs.msg import Quaternion
from hypothesis import assume, given
from hypothesis import strategies as st

LETTERS = ("xyz", "xzy", "yzx", "yxz", "zxy", "zyx")
angles = st.floats(-7.0, 7.0) | st.sampled_from([0.0, math.pi / 2, -math.pi / 2, math.pi])
vectors = st.tuples(*[st.floats(-10.0, 10.0)] * 3)
axes_names = st.sampled_from([f"{kind}{letters}" for kind in "sr" for letters in LETTERS])


@given(angles, angles, angles, axes_names)
def test_angles_come_back_as_the_same_turn_for_all_12_kinds_of_axes(a: float, b: float, c: float, axes: str) -> None:
    matrix = tft.euler_matrix(a, b, c, axes)
    again = tft.euler_from_matrix(matrix, axes)
    assert np.allclose(tft.euler_matrix(*again, axes), matrix, atol=1e-7)
    assert np.allclose(
        tft.euler_matrix(*tft.euler_from_quaternion(tft.quaternion_from_matrix(matrix), axes), axes), matrix
    )


@given(angles, angles, angles)
def test_roll_pitch_and_yaw_are_turns_about_fixed_axes_one_after_the_other(
    roll: float, pitch: float, yaw: float
) -> None:
    about = [tft.rotation_matrix(angle, axis) for angle, axis in zip((roll, pitch, yaw), np.identity(3), strict=True)]
    assert np.allclose(tft.euler_matrix(roll, pitch, yaw), about[2] @ about[1] @ about[0])
    assert np.allclose(tft.euler_matrix(yaw, pitch, roll, "rzyx"), about[2] @ about[1] @ about[0])


def test_figures_that_are_published() -> None:
    assert np.allclose(tft.quaternion_from_euler(1, 2, 3, "ryxz"), [0.310622, -0.718287, 0.444435, 0.435953])
    assert np.isclose(sum(tft.euler_matrix(1, 2, 3, "syxz")[0]), -1.34786452)
    assert np.allclose(tft.quaternion_multiply([1, -2, 3, 4], [-5, 6, 7, 8]), [-44, -14, 48, 28])
    assert np.allclose(tft.quaternion_about_axis(0.123, (1, 0, 0)), [0.06146124, 0, 0, 0.99810947])
    assert np.allclose(tft.euler_from_quaternion([0.06146124, 0, 0, 0.99810947]), [0.123, 0, 0])
    turn = tft.quaternion_from_matrix(tft.rotation_matrix(0.123, (1, 2, 3)))
    assert np.allclose(turn, [0.0164262, 0.0328524, 0.0492786, 0.9981095])


@given(angles, vectors, vectors, vectors)
def test_turns_as_quaternions_and_matrices_agree(angle: float, axis: tuple, point: tuple, other: tuple) -> None:
    assume(np.linalg.norm(axis) > 1e-3)
    turn = tft.quaternion_about_axis(angle, axis)
    assert np.allclose(tft.quaternion_multiply(turn, tft.quaternion_inverse(turn)), [0, 0, 0, 1])
    again = tft.quaternion_about_axis(0.5, (0, 1, 0))
    both = tft.concatenate_matrices(tft.quaternion_matrix(turn), tft.quaternion_matrix(again))
    assert np.allclose(tft.quaternion_matrix(tft.quaternion_multiply(turn, again)), both)
    matrix = tft.rotation_matrix(angle, axis, point)
    assert np.allclose(matrix @ [*point, 1], [*point, 1])
    assert np.allclose(tft.inverse_matrix(matrix) @ matrix, np.identity(4))
    shifted = tft.translation_matrix(other) @ matrix
    assert np.allclose(tft.translation_from_matrix(shifted), np.array(other) + matrix[:3, 3])


def test_half_way_between_two_turns() -> None:
    one, two = tft.quaternion_from_euler(0, 0, 0.2), tft.quaternion_from_euler(0, 0, 1.0)
    assert tft.euler_from_quaternion(tft.quaternion_slerp(one, two, 0.25))[2] == pytest.approx(0.4)
    assert np.allclose(tft.quaternion_slerp(one, -np.array(two), 0.25), tft.quaternion_from_euler(0, 0, 0.4))
    assert np.allclose(tft.quaternion_slerp(one, two, 1.0), two)


def test_vectors() -> None:
    assert np.allclose(tft.unit_vector([3, 4]), [0.6, 0.8])


def test_mistakes_are_explained() -> None:
    with pytest.raises(TypeError, match=r"write \[q\.x, q\.y, q\.z, q\.w\]"):
        tft.euler_from_quaternion(Quaternion())
    for axes in ("xyz", "szyz", (0, 0, 0, 0)):
        with pytest.raises(ValueError, match="axes must be such as 'sxyz' or 'rzyx', with each axis once, got"):
            tft.quaternion_from_euler(0, 0, 0, axes)
