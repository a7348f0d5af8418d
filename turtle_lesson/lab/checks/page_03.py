"""Page 03: the navigator, first driving blind, then by the pose."""

from __future__ import annotations

import math
import re
from typing import Any

from ..words import number, point, turned
from .assertions import no_answer, no_errors, node, offers, publishes
from .functions import learner_function, returns
from .navigation import (
    COMMAND_TYPE,
    COMMANDS,
    LONGEST,
    MIDDLE,
    NAVIGATE,
    NAVIGATE_TYPE,
    NEAR,
    POSE,
    POSE_TYPE,
    Way,
    accepts,
    answered,
    arrived,
    ask_for,
    ask_soon_for,
    at_rest,
    driven,
    facing,
    go,
    put,
    refuses,
    steady_commands,
    stopped,
    turning,
    turns_little,
    where,
)
from .probe import Probe
from .registry import Expectation, check, expectation
from .results import CannotLook, Seen, hinted

RUN = "ros2 run robot_controller navigator"

START = 5.544
"""Where the blind navigator believes that each drive begins (m), in x and in y."""

BLIND_SPEED = 0.5
STRAIGHT = Way("(7.544, 5.544)", (START, START, 0.0), (START + 2, START, 0.0))
BESIDE = Way("(5.544, 4.544)", (START, START, 0.0), (START, START - 1, 0.0))
BEHIND = Way("(4.544, 6.544)", (START, START, 0.0), (START - 1, START + 1, 0.0))

A_GOAL = Way("a goal", MIDDLE, (4.0, 3.0, 1.57))
TO_THE_LEFT = Way("a goal in the west", (8.0, 5.0, 3.05), (5.0, 4.8, -3.05))
TO_THE_RIGHT = Way("another in the west", (8.0, 5.0, -3.05), (5.0, 5.2, 3.05))
CORNERS = (
    Way("the lower left corner", (1.0, 1.0, -2.3), (0.0, 0.0, -2.3)),
    Way("the upper right corner", (10.0, 10.0, 0.8), (11.08, 11.08, 0.8)),
)
ANYWHERE = (0.0, 7.0, -7.0)
"""Headings that are numbers, and so make sense."""


def navigator_is_there(start: str = RUN) -> list[Expectation]:
    """The node, its service and its commands; `start` is the command that starts it."""
    return [
        node("/navigator", start),
        offers(NAVIGATE, NAVIGATE_TYPE, by="/navigator"),
        publishes(COMMANDS, COMMAND_TYPE, by="/navigator"),
    ]


# -- driving blind -----------------------------------------------------------------------------------------------------


@check(
    "simple_navigator",
    points=3,
    limit=420,
    learnt="Open loop: distance divided by speed says how long to send a command, and nothing says where it led.",
)
def simple_navigator() -> list[Expectation]:
    """A navigator that drives straight ahead for as long as the way takes, stops, and says how long it took."""
    return [
        *navigator_is_there(),
        _takes(STRAIGHT),
        _drives_ahead(STRAIGHT),
        steady_commands(STRAIGHT),
        stopped(STRAIGHT),
        _takes(BESIDE),
        _takes(BEHIND),
        no_errors(),
    ]


def _seconds(way: Way) -> float:
    return math.dist(way.begin[:2], way.goal[:2]) / BLIND_SPEED


def _takes(way: Way) -> Expectation:
    wanted = _seconds(way)

    def look(probe: Probe) -> Seen:
        it = go(probe, way)
        if it.answer.response is None:
            return no_answer(probe, f"no answer in {LONGEST:g} s")
        said, took = float(it.response.time_taken), it.answer.seconds
        seen = f"time_taken is {number(said)} s, and the answer came after {number(took)} s"
        step = hinted(
            "Which distance did your node calculate, from where, and which time follows from it at 0.5 m/s?", 1
        )
        return Seen(abs(said - wanted) <= 0.15 and abs(took - wanted) <= 0.2, seen, step)

    return Expectation(f"the goal {way.name} takes {number(wanted)} s", look)


def _drives_ahead(way: Way) -> Expectation:
    metres = _seconds(way) * BLIND_SPEED

    def look(probe: Probe) -> Seen:
        it = go(probe, way)
        it.moving()
        end = it.end(at_rest=True)
        ahead, beside = end.x - it.begin.x, end.y - it.begin.y
        seen = f"it drove {number(math.hypot(ahead, beside))} m"
        step = hinted("How fast does the turtle drive, for how long, and what stops it?", 2)
        return Seen(abs(ahead - metres) <= 0.1 and abs(beside) <= 0.05, f"{seen}, to {point(end.x, end.y)}", step)

    return Expectation(f"it drives {metres:g} m straight ahead", look)


# -- angles ------------------------------------------------------------------------------------------------------------

DIFFERENCES = hinted(
    "Which whole turns can be added to that difference, or taken away from it, so that it becomes smaller?",
    "Open Hint 1, then Hint 2, under the exercise.",
)


@check(
    "short_way",
    points=3,
    limit=60,
    learnt="The difference of two angles is the short way only after it has been wrapped.",
)
def short_way() -> list[Expectation]:
    """A difference of angles that is always the short way round."""

    def turn(expected: str, *examples: tuple[float, float, float]) -> Expectation:
        cases = [((wanted, heading), turned(right)) for wanted, heading, right in examples]
        return returns("turn_to", cases, expected, DIFFERENCES, within=1e-6)

    seam = math.tau - 6.26
    return [
        turn(
            "an ordinary difference stays as it is",
            (1.0, 0.5, 0.5),
            (0.5, 1.0, -0.5),
            (-1.0, 1.0, -2.0),
            (2.0, 2.0, 0.0),
        ),
        turn("across due west to the left", (-3.13, 3.13, seam), (-2.0, 2.0, -4.0)),
        turn("across due west to the right", (3.13, -3.13, -seam), (2.0, -2.0, 4.0)),
        turn("more than a whole turn", (9.0, -3.0, 12.0), (-9.0, 3.0, -12.0), (0.5, 13.0, -12.5), (20.0, 0.0, 20.0)),
        _half_a_turn,
        _steers_across("to the left", TO_THE_LEFT),
        _steers_across("to the right", TO_THE_RIGHT),
        no_errors(),
    ]


@expectation("half a turn, either way round")
def _half_a_turn(probe: Probe) -> Seen:
    came = probe.call(learner_function(probe, "turn_to"), math.pi, 0.0)
    if not isinstance(came, float):
        return Seen(False, f"turn_to(3.1416, 0.0) is {came!r}", "Does turn_to end with `return`, in every case?")
    return Seen(abs(abs(came) - math.pi) < 1e-6, f"turn_to(3.1416, 0.0) is {number(came, 4)}", DIFFERENCES)


def _steers_across(where_to: str, way: Way) -> Expectation:
    """The notebook's `steer`, which calls turn_to, drives the turtle across due west without a pirouette."""

    def look(probe: Probe) -> Seen:
        steer = learner_function(probe, "steer")
        heard = probe.listen(POSE, POSE_TYPE)
        put(probe, way.begin)
        poses, goal = [where(probe)], _pose(way.goal)
        while math.hypot(poses[-1].x - goal.x, poses[-1].y - goal.y) > NEAR and len(poses) < 60:
            speed, turn = probe.call(steer, poses[-1], goal)
            probe.publish(COMMANDS, COMMAND_TYPE, linear__x=float(speed), angular__z=float(turn))
            probe.wait(0.1)
            poses.append(heard[-1].message)
        probe.publish(COMMANDS, COMMAND_TYPE)
        degrees = math.degrees(turning(poses))
        there = math.hypot(poses[-1].x - goal.x, poses[-1].y - goal.y) <= NEAR
        seen = (
            f"it {'arrived' if there else 'did not arrive within 6 s'}, and turned by {number(degrees, 0)}° on the way"
        )
        return Seen(there and degrees <= 60.0, seen, DIFFERENCES)

    return Expectation(f"a drive due west, with a turn {where_to}", look)


def _pose(goal: tuple[float, float, float]) -> Any:
    from turtlesim.msg import Pose

    x, y, theta = goal
    return Pose(x=x, y=y, theta=theta)


# -- with open eyes ----------------------------------------------------------------------------------------------------


@check(
    "navigator",
    points=6,
    limit=600,
    learnt="Closed loop: a node that looks ten times a second needs no plan, and a good service refuses what makes no sense.",
)
def navigator() -> list[Expectation]:
    """A navigator that steers by the pose until it is there, and refuses goals that make no sense."""
    return [
        *navigator_is_there(),
        answered(A_GOAL),
        arrived(A_GOAL, at_rest=True),
        facing(A_GOAL, at_rest=True),
        steady_commands(A_GOAL),
        stopped(A_GOAL),
        _logged(A_GOAL),
        turns_little(TO_THE_LEFT, 90.0),
        turns_little(TO_THE_RIGHT, 90.0),
        refuses("x outside the world", (20.0, 5.0, 0.0), (-1.0, 5.0, 0.0), (11.2, 5.0, 0.0), (-0.1, 5.0, 0.0)),
        refuses("y outside the world", (5.0, 20.0, 0.0), (5.0, -1.0, 0.0), (5.0, 11.2, 0.0), (5.0, -0.1, 0.0)),
        refuses("x and y that are no finite numbers", (math.nan, 5.0, 0.0), (5.0, math.nan, 0.0), (math.inf, 5.0, 0.0)),
        refuses("theta that is no finite number", (5.0, 6.0, math.nan), (5.0, 6.0, math.inf), (5.0, 6.0, -math.inf)),
        accepts("goals at the very edge", *CORNERS),
        accepts("any heading", *(Way(f"heading {theta:g}", MIDDLE, (6.5, 5.5, theta)) for theta in ANYWHERE)),
        _keeps_its_goal,
        no_errors(),
    ]


def _logged(way: Way) -> Expectation:
    """A line of the navigator's log has both numbers of the goal."""

    def look(probe: Probe) -> Seen:
        driven(probe, way)
        lines = [text for _, name, text in probe.log if name == "navigator"]
        x, y = (rf"(?<![\d.]){each:g}(\.0+)?(?!\.?\d)" for each in way.goal[:2])
        found = [text for text in lines if re.search(x, text) and re.search(y, text)]
        step = "Which line of on_goal writes to the log, and is it reached for a goal that is accepted?"
        seen = f"“{found[0]}”" if found else "no line of its log has 4 and 3 in it"
        return Seen(bool(found), seen, step)

    return Expectation("the goal (4, 3) is logged", look)


@expectation("refused on its way to (9, 3), it still gets there")
def _keeps_its_goal(probe: Probe) -> Seen:
    """A goal that is refused on the way changes nothing."""
    put(probe, (3.0, 3.0, 0.0))
    first = ask_soon_for(probe, (9.0, 3.0, 0.0))
    probe.wait(0.5)
    refused = ask_for(probe, (20.0, 5.0, 0.0), 1.0).response
    if refused is None or refused.success:
        raise CannotLook("the goal (20, 5, 0) was not refused on the way")
    probe.wait_for(lambda: first() and at_rest(probe.listen(POSE, POSE_TYPE)), 20.0)
    end = where(probe)
    step = hinted("Is self.goal changed before the goal has been judged?", 1)
    seen = f"the turtle went to {point(end.x, end.y)}"
    return Seen(math.hypot(end.x - 9.0, end.y - 3.0) <= NEAR, seen, step)
