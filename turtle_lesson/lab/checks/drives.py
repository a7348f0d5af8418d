"""One drive of the navigator, seen from outside: what was asked and answered, the commands, and what the turtle did."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field
from typing import Any

from ..track import WORLD
from ..words import angle, number, point, turned
from .exam import Answer, Exam, Heard
from .registry import Expectation
from .rows import CannotLook, Seen

NAVIGATE, NAVIGATE_TYPE = "/navigate_to", "robot_controller/srv/NavigateTo"
POSE, POSE_TYPE = "/turtle1/pose", "turtlesim/msg/Pose"
COMMANDS, COMMAND_TYPE = "/turtle1/cmd_vel", "geometry_msgs/msg/Twist"

TICK = 0.016
"""Robot time, s, between two poses of turtlesim."""

NEAR = 0.2
"""A goal is reached within this distance, m."""

STILL = 1e-3
"""A turtle slower than this, m/s and rad/s, stands."""

LONGEST = 90.0
"""Robot time, s, that one drive may take."""

Goal = tuple[float, float, float]


@dataclass
class Drive:
    """A goal (x, y in m, theta in rad), the answer, and the commands and poses from the question to a second after it."""

    goal: Goal
    begin: Any
    answer: Answer
    commands: list[Heard] = field(default_factory=list)
    poses: list[Heard] = field(default_factory=list)

    @property
    def response(self) -> Any:
        """What was answered. Raises CannotLook where nothing was."""
        if self.answer.response is None:
            raise CannotLook(f"the goal {point(*self.goal[:2])} was not answered")
        return self.answer.response

    def end(self) -> Any:
        """The last pose by the time of the answer."""
        by_then = [each.message for each in self.poses if each.at <= self.answer.answered + TICK]
        return by_then[-1] if by_then else self.begin

    def moving(self) -> tuple[float, float]:
        """From when to when the turtle moved (robot time, s). Raises CannotLook if it never did."""
        times = [each.at for each in self.poses if is_moving(each.message)]
        if not times:
            raise CannotLook("the turtle never moved")
        return times[0] - TICK, times[-1]

    def distance(self) -> float:
        """How far from the goal the turtle was when the answer came, m."""
        end = self.end()
        return math.hypot(self.goal[0] - end.x, self.goal[1] - end.y)


def is_moving(pose: Any) -> bool:
    """Whether a turtle says that it moves."""
    return abs(pose.linear_velocity) > STILL or abs(pose.angular_velocity) > STILL


def where(exam: Exam) -> Any:
    """The turtle's newest pose. Raises CannotLook where none comes."""
    heard = exam.listen(POSE, POSE_TYPE)
    if not exam.wait_for(lambda: heard, 0.5):
        raise CannotLook(f"no pose comes on {POSE}")
    exam.wait(2 * TICK)
    return heard[-1].message


def drive(exam: Exam, name: str, choose: Any) -> Drive:
    """Drive to the goal that `choose(pose)` gives; the first time it is done, from then on remembered by its name."""
    return exam.once(("drive", name), lambda: _drive(exam, choose(where(exam))))


def _drive(exam: Exam, goal: Goal) -> Drive:
    begin = where(exam)
    poses = exam.listen(POSE, POSE_TYPE)
    try:
        commands = exam.listen(COMMANDS, COMMAND_TYPE)
    except CannotLook:
        commands = []
    first_pose, first_command = len(poses), len(commands)
    x, y, theta = goal
    answer = exam.ask(NAVIGATE, NAVIGATE_TYPE, LONGEST, x=x, y=y, theta=theta)
    exam.wait(1.0)
    return Drive(goal, begin, answer, commands[first_command:], poses[first_pose:])


# -- goals -------------------------------------------------------------------------------------------------------------

PLACES = tuple((float(x), float(y)) for x, y in itertools.product((2, 4, 6, 8, 9), repeat=2))


def two_metres_away(pose: Any) -> Goal:
    """The round place that is nearest to being 2 m away, facing up."""
    x, y = min(PLACES, key=lambda place: abs(math.hypot(place[0] - pose.x, place[1] - pose.y) - 2.0))
    return x, y, 1.57


def due_west(pose: Any) -> Goal:
    """A place to the left on the map, where an angle difference that is not wrapped goes wrong, facing left."""
    x = pose.x - 1.5 if pose.x > 2.0 else pose.x + 1.5
    return round(x, 1), round(min(max(pose.y, 0.5), WORLD - 0.5), 1), 3.14


def far_away(pose: Any) -> Goal:
    """The corner that is farthest away."""
    corners = itertools.product((1.0, WORLD - 1.0), repeat=2)
    x, y = max(corners, key=lambda place: math.hypot(place[0] - pose.x, place[1] - pose.y))
    return round(x, 1), round(y, 1), 0.0


# -- expectations ------------------------------------------------------------------------------------------------------


def answered(name: str, choose: Any, success: bool = True) -> Expectation:
    """A goal is answered in time; with success True, where that is expected."""

    def look(exam: Exam) -> Seen:
        it = drive(exam, name, choose)
        goal = f"goal {point(*it.goal[:2])}"
        if it.answer.response is None:
            step = (
                "Does the callback end with `return response`? Does it wait for a pose that it cannot hear meanwhile?"
            )
            return Seen(False, f"{goal}: no answer in {LONGEST:g} s", step)
        seen = f"{goal}: success is {it.response.success} after {number(it.answer.seconds)} s"
        step = "Judge it at the end, by where the turtle is then; and give it time enough (goal_timeout)."
        return Seen(bool(it.response.success) or not success, seen, step)

    return Expectation(f"{name}: " + ("success is True" if success else "it is answered"), look)


def arrived(name: str, choose: Any, near: float = NEAR) -> Expectation:
    """The turtle is within some distance (m) of the goal when the answer comes."""

    def look(exam: Exam) -> Seen:
        it = drive(exam, name, choose)
        it.response  # noqa: B018  (raises where there is none)
        end, distance = it.end(), it.distance()
        seen = f"at {point(end.x, end.y)}, {number(distance)} m from {point(*it.goal[:2])}"
        step = "Look at /turtle1/pose on the way, and steer by it: a plan made at the start misses."
        return Seen(distance <= near, seen, step)

    return Expectation(f"{name}: the turtle within {near:g} m of it", look)


def facing(name: str, choose: Any, near: float = 0.2) -> Expectation:
    """The turtle has the goal's heading, within an angle (rad), when the answer comes."""

    def look(exam: Exam) -> Seen:
        it = drive(exam, name, choose)
        it.response  # noqa: B018
        error = turned(it.goal[2] - it.end().theta)
        step = "At the goal, turn to its theta; wrap the difference: math.remainder(angle, math.tau)."
        return Seen(abs(error) <= near, f"{angle(error)} off", step)

    return Expectation(f"{name}: heading within {near:g} rad", look)


def honest_time(name: str, choose: Any, within: float = 0.1) -> Expectation:
    """time_taken is how long the turtle really moved, give or take (s)."""

    def look(exam: Exam) -> Seen:
        it = drive(exam, name, choose)
        begin, end = it.moving()
        truth, said = end - begin, float(it.response.time_taken)
        seen = f"it said {number(said)} s; the turtle moved for {number(truth)} s"
        step = "Read self.get_clock().now() at the first command and at the one that stops it."
        return Seen(abs(said - truth) <= within, seen, step)

    return Expectation(f"time_taken within {within:g} s of the moving time", look)


def stopped(name: str, choose: Any) -> Expectation:
    """The last command is all zero, and the turtle stands a second after the answer."""

    def look(exam: Exam) -> Seen:
        it = drive(exam, name, choose)
        it.response  # noqa: B018
        if not it.commands:
            raise CannotLook(f"no command came on {COMMANDS}")
        last = it.commands[-1].message
        speeds = (last.linear.x, last.linear.y, last.angular.z)
        if any(speeds):
            seen = f"it was {number(last.linear.x)} m/s and {number(last.angular.z)} rad/s"
            return Seen(False, seen, "Publish an empty Twist() at the end, however the drive ends.")
        still = not is_moving(it.poses[-1].message)
        return Seen(still, "it was, and the turtle stands" if still else "it was, and the turtle moves on")

    return Expectation("the last command is zero", look)


def steady_commands(name: str, choose: Any, most: float = 0.15) -> Expectation:
    """No two commands on the way are farther apart than this (s): ten a second."""

    def look(exam: Exam) -> Seen:
        it = drive(exam, name, choose)
        begin, end = it.moving()
        times = [each.at for each in it.commands if begin - 0.2 <= each.at <= end + 0.2]
        gaps = [after - before for before, after in itertools.pairwise(times)]
        if not gaps:
            return Seen(False, "one command for the whole way", "The turtle forgets a command after 1 s: send on.")
        seen = f"the longest gap was {number(1000 * max(gaps), 0)} ms"
        return Seen(max(gaps) <= most, seen, "Send one every 0.1 s, from a timer.")

    return Expectation("ten commands a second on the way", look)


def refuses(what: str, x: float, y: float, theta: float = 0.0, *, after: Goal | None = None) -> Expectation:
    """A goal that makes no sense is refused at once: success False within a second, and the turtle stays.

    It is only asked where the goal `after` was refused: what refuses nothing would fill the log.
    """

    def look(exam: Exam) -> Seen:
        if after is not None and _not_refused(exam, after):
            raise CannotLook(f"the goal {point(*after[:2])} was not refused")
        fault = _not_refused(exam, (x, y, theta))
        step = "Look at the request first: math.isfinite(…), and 0 ≤ x, y ≤ 11.09; else return response."
        return Seen(not fault, fault or "refused at once", step)

    return Expectation(f"refuses {what}", look)


def _not_refused(exam: Exam, goal: Goal) -> str:
    """What happened instead when a goal that makes no sense was asked, or ""; once it is asked, it is remembered."""
    return exam.once(("refused", goal), lambda: _ask_nonsense(exam, goal))


def _ask_nonsense(exam: Exam, goal: Goal) -> str:
    x, y, theta = goal
    begin = where(exam)
    answer = exam.ask(NAVIGATE, NAVIGATE_TYPE, 5.0, x=x, y=y, theta=theta)
    exam.wait(0.3)
    end = where(exam)
    if answer.response is None:
        return "no answer in 5 s"
    if answer.response.success:
        return "success is True"
    if answer.seconds > 1.0:
        return f"answered after {number(answer.seconds)} s only"
    return "the turtle moved" if math.hypot(end.x - begin.x, end.y - begin.y) > 0.05 else ""
