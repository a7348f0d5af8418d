"""Page 03: the navigator, first driving blind, then by the pose."""

from __future__ import annotations

import math

from .drives import (
    COMMAND_TYPE,
    COMMANDS,
    NAVIGATE,
    NAVIGATE_TYPE,
    answered,
    arrived,
    due_west,
    honest_time,
    refuses,
    steady_commands,
    stopped,
    two_metres_away,
)
from .parts import no_errors, node, offers, publishes
from .registry import Expectation, check

PAGE = "03_navigator"
RUN = "ros2 run robot_controller navigator"
NEAR_GOAL, WEST = "a goal 2 m away", "a goal due west"


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
        steady_commands(NEAR_GOAL, two_metres_away),
        stopped(NEAR_GOAL, two_metres_away),
        no_errors(),
    ]


@check("navigator", page=PAGE, points=6, limit=220)
def navigator() -> list[Expectation]:
    """A navigator that steers by the pose until it is there."""
    return [
        *navigator_is_there(),
        answered(NEAR_GOAL, two_metres_away),
        arrived(NEAR_GOAL, two_metres_away),
        honest_time(NEAR_GOAL, two_metres_away),
        steady_commands(NEAR_GOAL, two_metres_away),
        stopped(NEAR_GOAL, two_metres_away),
        answered(WEST, due_west),
        arrived(WEST, due_west),
        refuses("a goal that is no number", math.nan, 5.0),
        refuses("a goal outside the world", 20.0, 5.0),
        no_errors(),
    ]
