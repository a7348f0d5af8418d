"""Numbers in sentences: fixed decimals, both units for angles, and never a minus zero."""

import math
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from turtle_lesson.lab.words import angle, count, listed, number, point, rate, turned


@pytest.mark.parametrize(
    ("value", "decimals", "text"),
    [
        (0.0, 2, "0.00"),
        (-0.0, 2, "0.00"),
        (-0.004, 2, "0.00"),
        (-0.006, 2, "-0.01"),
        (-0.4, 0, "0"),
        (-10.0, 1, "-10.0"),
        (3.14159, 2, "3.14"),
        (float("nan"), 2, "not a number"),
        (float("inf"), 2, "infinite"),
        (float("-inf"), 2, "minus infinite"),
    ],
)
def test_a_number_has_its_decimals(value, decimals, text):
    assert number(value, decimals) == text


@given(st.floats(allow_nan=False, allow_infinity=False, width=32), st.integers(0, 4))
def test_no_number_is_ever_minus_zero(value, decimals):
    text = number(value, decimals)
    assert re.fullmatch(r"-?\d+(\.\d+)?", text)
    assert not (text.startswith("-") and float(text) == 0)
    assert float(text) == pytest.approx(value, abs=10**-decimals)


@given(st.floats(-1000, 1000))
def test_an_angle_is_said_in_radians_and_in_degrees(radians):
    match = re.fullmatch(r"(-?\d+\.\d\d) rad \((-?\d+\.\d)°\)", angle(radians))
    assert match and "-0.00 " not in angle(radians) and "(-0.0°" not in angle(radians)
    assert float(match[2]) == pytest.approx(math.degrees(radians), abs=0.051)


@given(st.floats(-1000, 1000))
def test_a_turn_is_never_more_than_half_a_circle(radians):
    assert -math.pi < turned(radians) <= math.pi
    assert math.cos(turned(radians)) == pytest.approx(math.cos(radians), abs=1e-9)


def test_half_a_circle_is_a_turn_to_the_left():
    assert turned(-math.pi) == math.pi


def test_words_for_points_counts_and_lists():
    assert point(5.544445, -0.0001) == "(5.54, 0.00)"
    assert [count(each, "message") for each in (0, 1, 2)] == ["no message", "1 message", "2 messages"]
    assert [listed(list(each)) for each in ("", "a", "ab", "abc")] == ["", "a", "a and b", "a, b and c"]


def test_a_rate_names_mean_shortest_and_longest_interval():
    stamps = np.array([0, 100, 210, 300]) * 1_000_000
    assert rate(stamps) == (
        "4 messages, one every 100.0 ms on average (10.0 Hz), the shortest interval 90.0 ms and the longest 110.0 ms"
    )
    assert rate(stamps[:1]) == "1 message"
    assert rate(np.zeros(3, int)).startswith("3 messages, one every 0.0 ms on average, the shortest")
