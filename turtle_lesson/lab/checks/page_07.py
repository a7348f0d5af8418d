"""Page 07: what was done from the command line."""

from __future__ import annotations

import math

from ..words import number
from . import page_04
from .drives import COMMAND_TYPE, COMMANDS, POSE, POSE_TYPE
from .exam import Exam
from .parts import parameter
from .registry import Expectation, check
from .rows import CannotLook, Seen
from .streams import judge_rate, rate, some

PAGE = "07_command_line"
TWIN, TWIN_PLACE = "/turtle2", (2.0, 9.0)


@check("tuned", page=PAGE, points=2, limit=10)
def tuned() -> list[Expectation]:
    """A parameter that was changed while its node runs."""
    return [
        parameter("/status_monitor", "publish_rate", 20),
        rate(page_04.STATUS, page_04.STATUS_TYPE, hz=20),
    ]


@check("second_turtle", page=PAGE, points=2, limit=10)
def second_turtle() -> list[Expectation]:
    """A service of the simulator was called: there are two turtles."""
    return [
        Expectation(f"{TWIN}/pose is published", _twin_is_there),
        Expectation("turtle2 near (2.00, 9.00) m", _twin_in_place),
    ]


def _twin_is_there(exam: Exam) -> Seen:
    there = bool(exam.publishers(f"{TWIN}/pose"))
    step = "The request's field name says how the turtle is called: ros2 interface show turtlesim/srv/Spawn."
    return Seen(there, "it is" if there else "it is not", step)


def _twin_in_place(exam: Exam) -> Seen:
    pose = some(exam, f"{TWIN}/pose", POSE_TYPE, 0.1)[-1].message
    away = math.hypot(pose.x - TWIN_PLACE[0], pose.y - TWIN_PLACE[1])
    return Seen(away < 0.1, f"it is {number(away)} m from there", "x and y stand in the request: {x: 2.0, y: 9.0, …}.")


@check("circle", page=PAGE, points=3, limit=15)
def circle() -> list[Expectation]:
    """Commands from a terminal drive the turtle round and round."""
    return [
        Expectation(f"{COMMANDS}: a message every 100 ms ± 10 ms", _ten_a_second),
        Expectation("the turtle drives, and turns", _goes_round),
    ]


def _ten_a_second(exam: Exam) -> Seen:
    good, seen, _ = judge_rate(some(exam, COMMANDS, COMMAND_TYPE, 2.0), 10, 0.010)  # the navigator may publish, too
    return Seen(good, seen, "ros2 topic pub --rate 10 … & goes on behind the scenes.")


def _goes_round(exam: Exam) -> Seen:
    poses = [each.message for each in some(exam, POSE, POSE_TYPE, 2.0)]
    slow, turn = min(each.linear_velocity for each in poses), min(abs(each.angular_velocity) for each in poses)
    if not math.isfinite(slow + turn):
        raise CannotLook("the pose is no number")
    seen = f"at least {number(slow)} m/s, and {number(turn)} rad/s"
    return Seen(slow > 0.1 and turn > 0.1, seen, 'A circle is both at once: "{linear: {x: 1.0}, angular: {z: 0.5}}".')
