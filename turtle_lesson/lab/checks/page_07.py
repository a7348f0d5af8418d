"""Page 07: what was done from the command line."""

from __future__ import annotations

import math

from ..words import angle, number, point, turned
from . import page_04
from .assertions import no_errors, node, parameter
from .navigation import COMMAND_TYPE, COMMANDS, POSE, POSE_TYPE
from .probe import Probe, remembered
from .registry import Expectation, check
from .results import CannotLook, Seen, hinted
from .streams import rate, some

TWIN, TWIN_PLACE = "/turtle2", (2.0, 9.0, 1.57)
RADIUS = 2.0
"""Metres."""

SOON = 0.5
"""Robot time, s, after which what was typed last has its effect: a program is up, a timer has its new period."""


@check("tuned", points=2, limit=10, learnt="You can change a node while it runs, without its code.")
def tuned() -> list[Expectation]:
    """A parameter that was changed while its node runs."""
    return [
        node("/status_monitor", "ros2 launch robot_controller start_system.launch.py"),
        parameter("/status_monitor", "publish_rate", 20),
        rate(page_04.STATUS, page_04.STATUS_TYPE, hz=20, within=0.005, seconds=2.0, after=SOON),
        parameter("/obstacle_detector", "scan_rate", 5),
        no_errors(),
    ]


@check("second_turtle", points=2, limit=10, learnt="Any service can be found out about, and called, by hand.")
def second_turtle() -> list[Expectation]:
    """A service of the simulator was called: there are two turtles."""
    return [
        Expectation(f"{TWIN}/pose is published", _twin_is_there),
        Expectation(f"turtle2 at {point(*TWIN_PLACE[:2])}", _twin_in_place),
        Expectation("turtle2 faces up", _twin_faces_up),
        no_errors(),
    ]


def _twin_is_there(probe: Probe) -> Seen:
    there = bool(probe.publishers(f"{TWIN}/pose"))
    others = [topic for topic in probe.topics() if topic.endswith("/pose") and topic != POSE]
    seen = "it is" if there else f"there is {others[0]}" if others else "there is one turtle"
    return Seen(there, seen, "Which field of the request says what the turtle is called?")


def _twin_in_place(probe: Probe) -> Seen:
    pose = some(probe, f"{TWIN}/pose", POSE_TYPE, 0.1)[-1].message
    away = math.hypot(pose.x - TWIN_PLACE[0], pose.y - TWIN_PLACE[1])
    advice = "x and y are fields of the request. (/kill takes a turtle away again.)"
    return Seen(away < 0.05, f"it is at {point(pose.x, pose.y)}", advice)


def _twin_faces_up(probe: Probe) -> Seen:
    pose = some(probe, f"{TWIN}/pose", POSE_TYPE, 0.1)[-1].message
    advice = "theta is an angle in radians: how many are 90°? (/kill takes a turtle away again.)"
    return Seen(abs(turned(pose.theta - TWIN_PLACE[2])) < 0.02, f"it faces {angle(pose.theta)}", advice)


@check("circle", points=3, limit=15, learnt="A speed ahead and a turn, sent again and again, make a circle.")
def circle() -> list[Expectation]:
    """Commands from a terminal drive the turtle round and round."""
    return [
        Expectation(f"{COMMANDS}: ten messages a second", _ten_a_second),
        Expectation("the turtle drives ahead and turns left", _goes_round),
        Expectation(f"the circle's radius is {RADIUS:g} m", _radius),
        no_errors(),
    ]


def _ten_a_second(probe: Probe) -> Seen:
    """A command that was started twice sends twice as many; that is no mistake in it."""
    probe.wait(SOON)
    amount = len([owner for owner, _ in probe.publishers(COMMANDS) if owner != "/navigator"])
    if not amount:
        advice = "A command that is to go on while the check looks ends with &."
        return Seen(False, "no command in a terminal publishes", advice)
    heard = len(some(probe, COMMANDS, COMMAND_TYPE, 2.0)) / 2.0 / amount
    return Seen(
        abs(heard - 10.0) <= 0.5, f"{number(heard, 1)} a second", "ros2 topic pub -h names the option for the rate."
    )


@remembered
def _motion(probe: Probe) -> tuple[float, float]:
    """The turtle's speed ahead (m/s) and its turn (rad/s); each the smallest in two seconds."""
    commands = [each.message for each in some(probe, COMMANDS, COMMAND_TYPE, 0.5)]
    poses = [each.message for each in some(probe, POSE, POSE_TYPE, 2.0)]
    ahead = math.copysign(min(each.linear_velocity for each in poses), commands[-1].linear.x)
    turn = min((each.angular_velocity for each in poses), key=abs)
    if not math.isfinite(ahead + turn):
        raise CannotLook("the pose is not a number")
    return ahead, turn


def _goes_round(probe: Probe) -> Seen:
    ahead, turn = _motion(probe)
    advice = hinted("A circle is both at once, in one message: a speed ahead and a turn. Which sign is left?", 1)
    return Seen(ahead > 0.05 and turn > 0.05, f"{number(ahead)} m/s and {number(turn)} rad/s", advice)


def _radius(probe: Probe) -> Seen:
    ahead, turn = _motion(probe)
    if abs(turn) < 1e-3 or abs(ahead) < 1e-3:
        raise CannotLook("the turtle drives no circle")
    radius = abs(ahead / turn)
    advice = hinted("How far does it drive while it turns by one radian?", 2)
    return Seen(abs(radius - RADIUS) <= 0.1, f"it is {number(radius)} m", advice)
