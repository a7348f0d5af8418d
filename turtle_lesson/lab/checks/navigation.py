"""One drive of the navigator, seen from outside: the request and its answer, the commands, and what the turtle did."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..words import angle, number, point, turned
from .assertions import gaps_of
from .probe import Answer, Heard, Probe, remembered
from .registry import expectation
from .results import CannotLook, Seen, hinted

if TYPE_CHECKING:
    from robot_controller.srv import NavigateTo
    from turtlesim.msg import Pose

NAVIGATE, NAVIGATE_TYPE = "/navigate_to", "robot_controller/srv/NavigateTo"
POSE, POSE_TYPE = "/turtle1/pose", "turtlesim/msg/Pose"
COMMANDS, COMMAND_TYPE = "/turtle1/cmd_vel", "geometry_msgs/msg/Twist"
TELEPORT, TELEPORT_TYPE = "/turtle1/teleport_absolute", "turtlesim/srv/TeleportAbsolute"

TICK = 0.016
"""Robot time, s, between two poses of turtlesim."""

NEAR, ALIGNED = 0.2, 0.2
"""A goal is reached within this distance, m, and its heading within this angle, rad."""

LONGEST = 90.0
"""Robot time, s, that one drive may take."""

AT_REST = 0.5
"""A turtle that has not moved for so long, s, has come to rest."""

Goal = tuple[float, float, float]
MIDDLE: Goal = (5.5, 5.5, 0.0)


@dataclass(frozen=True)
class Way:
    """A drive as a row of a check tells of it: where the turtle is put, and the goal that it is sent to.

    Attributes:
        name: what rows call the goal, such as "a goal in the west".
        begin: x and y (m) and the heading (rad) that the turtle is given first; None where it starts from where it is.
        goal: the same of the goal.
    """

    name: str
    begin: Goal | None
    goal: Goal


@dataclass
class Drive:
    """A goal (x, y in m, theta in rad), the answer, and the commands and poses from the question to a second after it."""

    goal: Goal
    begin: Pose
    answer: Answer
    commands: list[Heard]
    poses: list[Heard]

    @property
    def response(self) -> NavigateTo.Response:
        """What was answered. Raises CannotLook where nothing was."""
        if self.answer.response is None:
            raise CannotLook(f"the goal {point(*self.goal[:2])} was not answered")
        return self.answer.response

    def end(self, at_rest: bool = False) -> Pose:
        """The last pose by the time of the answer; or the one in which the turtle came to rest."""
        if at_rest and self.poses:
            return self.poses[-1].message
        by_then = [each.message for each in self.poses if each.at <= self.answer.answered + TICK]
        return by_then[-1] if by_then else self.begin

    def moving(self) -> tuple[float, float]:
        """The robot times (s) between which the turtle moved. Raises CannotLook if it never did."""
        times = [each.at for each in self.poses if is_moving(each.message)]
        if not times:
            raise CannotLook("the turtle never moved")
        return times[0] - TICK, times[-1]

    def distance(self, at_rest: bool = False) -> float:
        """How far from the goal the turtle was when the answer came, or when it came to rest, m."""
        return away(self.end(at_rest), self.goal)


def is_moving(pose: Pose) -> bool:
    """Whether a turtle says that it moves."""
    return abs(pose.linear_velocity) > 1e-3 or abs(pose.angular_velocity) > 1e-3


def away(pose: Pose, place: Sequence[float]) -> float:
    """How far a pose is from a place, m."""
    return math.hypot(pose.x - place[0], pose.y - place[1])


def where(probe: Probe) -> Pose:
    """The turtle's newest pose. Raises CannotLook where none comes."""
    heard = probe.listen(POSE, POSE_TYPE)
    if not probe.wait_for(lambda: heard, 0.5):
        raise CannotLook(f"no pose comes on {POSE}")
    probe.wait(2 * TICK)
    return heard[-1].message


def put(probe: Probe, place: Goal) -> None:
    """Put the turtle somewhere. Raises CannotLook where the simulator does not answer."""
    x, y, theta = place
    if probe.ask(TELEPORT, TELEPORT_TYPE, 1.0, x=x, y=y, theta=theta).response is None:
        raise CannotLook(f"{TELEPORT} does not answer")
    probe.wait(3 * TICK)


def circle(
    probe: Probe, topic: str, type_name: str, speed: float, turn: float, seconds: float, before: float, after: float
) -> tuple[float, float, list[tuple[Heard, Heard]]]:
    """What a topic says while the turtle drives in a circle (m/s and rad/s) for some seconds, and stands before and after that.

    Returns when the drive began and ended, and each message with the pose before it. Raises CannotLook where none comes, or the
    turtle does not move.
    """
    poses, heard = probe.listen(POSE, POSE_TYPE), probe.listen(topic, type_name)
    probe.wait(before)
    began, first_pose, first = probe.now, len(poses), len(heard)
    for _ in range(round(10 * seconds)):
        probe.publish(COMMANDS, COMMAND_TYPE, linear__x=speed, angular__z=turn)
        probe.wait(0.1)
    probe.publish(COMMANDS, COMMAND_TYPE)
    ended = probe.now
    probe.wait(after)
    poses = poses[first_pose:]
    xs = [each.message.x for each in poses] or [0.0]
    if max(xs) - min(xs) < 0.1:
        raise CannotLook(f"the turtle does not move when {COMMANDS} says so: is the simulator running?")
    found = [(each, next((pose for pose in reversed(poses) if pose.at <= each.at), None)) for each in heard[first:]]
    pairs = [(each, pose) for each, pose in found if pose]
    if not pairs:
        raise CannotLook(f"no message came on {topic} while the turtle drove")
    return began, ended, pairs


def ask_for(probe: Probe, goal: Goal, timeout: float) -> Answer:
    """Ask the navigator for a goal, and let robot time pass until it answers or the timeout (s) is over."""
    x, y, theta = goal
    return probe.ask(NAVIGATE, NAVIGATE_TYPE, timeout, x=x, y=y, theta=theta)


def ask_soon_for(probe: Probe, goal: Goal) -> Callable[[], Answer | None]:
    """Ask the navigator for a goal without waiting; returns a function that gives the answer once it has come."""
    x, y, theta = goal
    return probe.ask_soon(NAVIGATE, NAVIGATE_TYPE, x=x, y=y, theta=theta)


def driven(probe: Probe, way: Way) -> Drive:
    """The drive on a way, whose goal was answered. Raises CannotLook where it was not."""
    it = drive(probe, way)
    it.response  # noqa: B018  (raises where there is none)
    return it


@remembered
def drive(probe: Probe, way: Way) -> Drive:
    """The drive on a way. Where the turtle is put at a beginning, time passes until it has come to rest."""
    if way.begin:
        put(probe, way.begin)
    begin = where(probe)
    poses = probe.listen(POSE, POSE_TYPE)
    try:
        commands = probe.listen(COMMANDS, COMMAND_TYPE)
    except CannotLook:
        commands = []
    first_pose, first_command = len(poses), len(commands)
    answer = ask_for(probe, way.goal, LONGEST)
    probe.wait(1.0)
    if way.begin and answer.response is not None:
        come_to_rest(probe, LONGEST)
    return Drive(way.goal, begin, answer, commands[first_command:], poses[first_pose:])


def missed(it: Drive, at_rest: bool = False, in_time: float = math.inf) -> str:
    """What was wrong with a drive, whose answer may take so long (s); "" if nothing was."""
    goal = point(*it.goal[:2])
    if it.answer.response is None:
        return f"{goal} was never answered"
    off, seconds = it.distance(at_rest), it.answer.seconds
    if it.response.success and off <= NEAR and seconds <= in_time:
        return ""
    return f"{goal}: success is {it.response.success} after {number(seconds, 1)} s, {number(off)} m away"


def at_rest(poses: list[Heard]) -> bool:
    """Whether the turtle has not moved for a while, by the newest poses."""
    return not any(is_moving(each.message) for each in poses[-round(AT_REST / TICK) :])


def come_to_rest(probe: Probe, timeout: float) -> None:
    """Let robot time pass until the turtle has come to rest, or the timeout (s) is over."""
    probe.wait_for(lambda: at_rest(probe.listen(POSE, POSE_TYPE)), timeout)


@expectation("{way.name}: success is True")
def answered(probe: Probe, way: Way) -> Seen:
    """A goal is answered in time, with success True."""
    it = drive(probe, way)
    if it.answer.response is None:
        return probe.no_answer(f"no answer to the goal {point(*it.goal[:2])} in {LONGEST:g} s")
    step = "What is response.success when on_goal returns the response?"
    return Seen(bool(it.response.success), it.answer.told, step)


@expectation(f"{{way.name}}: the turtle within {NEAR:g} m of it")
def arrived(probe: Probe, way: Way, at_rest: bool = False) -> Seen:
    """The turtle is near the goal when the answer comes, or when it has come to rest."""
    it = driven(probe, way)
    end, distance = it.end(at_rest), it.distance(at_rest)
    seen = f"at {point(end.x, end.y)}, {number(distance)} m from {point(*it.goal[:2])}"
    when = "in the end" if at_rest else "when the answer comes"
    step = f"Where is the turtle {when}, and what does /turtle1/pose say on the way?"
    return Seen(distance <= NEAR, seen, step)


@expectation(f"{{way.name}}: heading within {ALIGNED:g} rad")
def facing(probe: Probe, way: Way, at_rest: bool = False) -> Seen:
    """The turtle has the goal's heading when the answer comes or when it has come to rest."""
    it = driven(probe, way)
    error = turned(it.goal[2] - it.end(at_rest).theta)
    return Seen(abs(error) <= ALIGNED, f"{angle(error)} off", "At the goal the turtle turns to the goal's theta.")


@expectation("{way.name}: reached, with turns of {most:g}° at most")
def turns_little(probe: Probe, way: Way, most: float) -> Seen:
    """The turtle comes to the goal, and all its turns, to and fro, are an angle (in degrees) at most."""
    it = driven(probe, way)
    degrees = math.degrees(turning([it.begin, *(each.message for each in it.poses)]))
    seen = f"it came within {number(it.distance(at_rest=True))} m and turned by {number(degrees, 0)}° in all"
    step = hinted(
        "Between which two headings does the turtle choose the long way round?",
        "Look at turn_to once more: the exercise “the short way” has hints.",
    )
    return Seen(it.distance(at_rest=True) <= NEAR and degrees <= most, seen, step)


def turning(poses: list[Pose]) -> float:
    """The sum of all turns from pose to pose, to and fro, in rad."""
    return math.fsum(abs(turned(after.theta - before.theta)) for before, after in itertools.pairwise(poses))


@expectation("time_taken within 0.1 s of the moving time")
def honest_time(probe: Probe, way: Way) -> Seen:
    """time_taken is how long the turtle really moved, give or take a tenth of a second."""
    it = drive(probe, way)
    begin, end = it.moving()
    truth, said = end - begin, float(it.response.time_taken)
    seen = f"it said {number(said)} s; the turtle moved for {number(truth)} s"
    step = "Which two moments lie between the first command and the one that stops the turtle?"
    return Seen(abs(said - truth) <= 0.1, seen, step)


@expectation("the last command is zero")
def stopped(probe: Probe, way: Way) -> Seen:
    """The last command is all zero, and the turtle stands when it should have come to rest."""
    it = driven(probe, way)
    if not it.commands:
        raise CannotLook(f"no command came on {COMMANDS}")
    last = it.commands[-1].message
    if any((last.linear.x, last.linear.y, last.angular.z)):
        seen = f"it was {number(last.linear.x)} m/s and {number(last.angular.z)} rad/s"
        return Seen(False, seen, "What is the last command that is published, however the drive ends?")
    still = not is_moving(it.poses[-1].message)
    return Seen(still, "it was, and the turtle stands" if still else "it was, but the turtle still moves")


@expectation("ten commands a second on the way")
def steady_commands(probe: Probe, way: Way) -> Seen:
    """No two commands on the way are more than 0.15 s apart: ten a second."""
    it = drive(probe, way)
    begin, end = it.moving()
    gaps = gaps_of(each.at for each in it.commands if begin - 0.2 <= each.at <= end + 0.2)
    if not gaps:
        return Seen(False, "one command for the whole way", "The turtle forgets a command after 1 s: keep sending.")
    seen = f"the longest gap was {number(1000 * max(gaps), 0)} ms"
    return Seen(max(gaps) <= 0.15, seen, "How much time passes between two commands, at the most?")


@expectation("refuses {what}")
def refuses(probe: Probe, what: str, *goals: Goal) -> Seen:
    """Goals that make no sense are refused at once: success False within a second, and the turtle stays."""
    for goal in goals:
        if fault := _fault(probe, goal):
            step = "Which of the three numbers has to be looked at, and with which limits, before the goal is accepted?"
            return Seen(False, f"{_typed(goal)}: {fault}", hinted(step, 2))
    return Seen(True, f"{len(goals)} goals, all of them refused at once")


def _typed(goal: Goal) -> str:
    return "({}, {}, {})".format(*(f"{each:g}" for each in goal))


def _fault(probe: Probe, goal: Goal) -> str:
    """What happened when a goal that makes no sense was not refused, or ""; then the turtle is led back to the middle."""
    begin = where(probe)
    answer = ask_for(probe, goal, 5.0)
    probe.wait(0.3)
    end = where(probe)
    if answer.response is None:
        fault = "no answer in 5 s"
    elif answer.response.success:
        fault = "success is True"
    elif answer.seconds > 1.0:
        fault = f"answered only after {number(answer.seconds)} s"
    else:
        fault = "the turtle moved" if away(end, (begin.x, begin.y)) > 0.05 else ""
    if fault:
        ask_for(probe, MIDDLE, 5.0)
        come_to_rest(probe, 10.0)
    return fault


@expectation("accepts {what}")
def accepts(probe: Probe, what: str, *ways: Way) -> Seen:
    """Goals on the boundary of what makes sense are accepted."""
    for way in ways:
        response = drive(probe, way).response
        if not response.success:
            step = "Which numbers does your comparison still accept? The ends belong to the world."
            return Seen(False, f"{_typed(way.goal)}: success is False", hinted(step, 2))
    return Seen(True, f"{' and '.join(_typed(way.goal) for way in ways)}")
