"""Page 03: the navigator, first driving blind, then by the pose."""

from __future__ import annotations

import itertools
import math

from ..words import number, turned
from .drives import (
    COMMAND_TYPE,
    COMMANDS,
    NAVIGATE,
    NAVIGATE_TYPE,
    answered,
    arrived,
    drive,
    due_west,
    facing,
    honest_time,
    refuses,
    steady_commands,
    stopped,
    two_metres_away,
)
from .exam import Exam
from .parts import no_errors, node, offers, publishes
from .registry import Expectation, check
from .rows import CannotLook, Seen

PAGE = "03_navigator"
RUN = "ros2 run robot_controller navigator"
NEAR_GOAL, WEST = "a near goal", "a goal due west"
OUTSIDE = (20.0, 5.0, 0.0)

MOST_TURNED = 400.0
"""Degrees: at most half a turn towards the goal, half a turn to its heading, and a little for steering."""


def navigator_is_there() -> list[Expectation]:
    """The node, its service and its commands."""
    return [
        node("/navigator", RUN),
        offers(NAVIGATE, NAVIGATE_TYPE, by="/navigator"),
        publishes(COMMANDS, COMMAND_TYPE, by="/navigator"),
    ]


@check("simple_navigator", page=PAGE, points=3, limit=120)
def simple_navigator() -> list[Expectation]:
    """A navigator that takes a goal, sends commands, stops and answers, wherever it ends."""
    return [
        *navigator_is_there(),
        answered(NEAR_GOAL, two_metres_away, success=False),
        honest_time(NEAR_GOAL, two_metres_away),
        steady_commands(NEAR_GOAL, two_metres_away),
        stopped(NEAR_GOAL, two_metres_away),
        no_errors(),
    ]


@check("short_way", page=PAGE, points=3, limit=130)
def short_way() -> list[Expectation]:
    """A navigator that turns the short way, also across due west."""
    return [
        *navigator_is_there(),
        answered(WEST, due_west),
        arrived(WEST, due_west),
        facing(WEST, due_west),
        turns_little(),
        no_errors(),
    ]


def turns_little() -> Expectation:
    """All turns on the way to a goal due west, to and fro, are hardly more than a whole one."""

    def look(exam: Exam) -> Seen:
        it = drive(exam, WEST, due_west)
        headings = [it.begin.theta, *(each.message.theta for each in it.poses)]
        if not all(map(math.isfinite, headings)):
            raise CannotLook("the turtle's heading is no number")
        degrees = math.degrees(math.fsum(abs(turned(b - a)) for a, b in itertools.pairwise(headings)))
        if degrees < 1.0:
            raise CannotLook("the turtle never turned")
        step = "A difference of two angles is the short way only once it is wrapped: math.remainder(…, math.tau)."
        return Seen(degrees <= MOST_TURNED, f"it turned by {number(degrees, 0)}° in all", step)

    return Expectation(f"{WEST}: turns of {MOST_TURNED:g}° in all at most", look)


@check("navigator", page=PAGE, points=6, limit=220)
def navigator() -> list[Expectation]:
    """A navigator that steers by the pose until it is there."""
    return [
        *navigator_is_there(),
        answered(NEAR_GOAL, two_metres_away),
        arrived(NEAR_GOAL, two_metres_away),
        facing(NEAR_GOAL, two_metres_away),
        honest_time(NEAR_GOAL, two_metres_away),
        steady_commands(NEAR_GOAL, two_metres_away),
        stopped(NEAR_GOAL, two_metres_away),
        answered(WEST, due_west),
        arrived(WEST, due_west),
        refuses("a goal outside the world", *OUTSIDE),
        refuses("a goal that is no number", math.nan, 5.0, after=OUTSIDE),
        no_errors(),
    ]
