"""Page 00: a first command and a first goal of the reader's own."""

from __future__ import annotations

import math

from ..words import angle, number, point, turned
from .drives import NEAR, where
from .exam import Exam
from .registry import Expectation, check
from .rows import Seen

PAGE = "00_welcome"
CORNER = (2.0, 2.0)
UP = math.pi / 2
MIDDLE = 5.544445
"""Where the turtle starts, m."""

LITTLE = 0.1
"""What does not matter: radians of a heading, metres of a height."""


@check("face_up", page=PAGE, points=1, limit=5)
def face_up() -> list[Expectation]:
    """The turtle was turned on the spot, to face up."""
    return [
        Expectation(f"the turtle facing up, within {LITTLE:g} rad", _facing_up),
        Expectation("as high as before: it turned on the spot", _as_high),
    ]


def _facing_up(exam: Exam) -> Seen:
    heading = where(exam).theta
    step = "Set angular.z to a quarter turn, 1.57, and publish it once; a negative one turns back to the right."
    return Seen(abs(turned(heading - UP)) <= LITTLE, f"its heading is {angle(heading)}", step)


def _as_high(exam: Exam) -> Seen:
    y = where(exam).y
    step = "Leave linear.x at 0. To begin again: ros2 service call /reset std_srvs/srv/Empty"
    return Seen(abs(y - MIDDLE) <= LITTLE, f"its y is {number(y)} m", step)


@check("corner", page=PAGE, points=1, limit=5)
def corner() -> list[Expectation]:
    """The turtle was sent to (2, 2)."""
    return [Expectation(f"the turtle within {NEAR:g} m of {point(*CORNER)}", _in_the_corner)]


def _in_the_corner(exam: Exam) -> Seen:
    pose = where(exam)
    away = math.hypot(pose.x - CORNER[0], pose.y - CORNER[1])
    seen = f"it is at {point(pose.x, pose.y)}, {number(away)} m from there"
    return Seen(away <= NEAR, seen, "The request wants x=2.0 and y=2.0; then client.call(it).")
