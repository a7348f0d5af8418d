"""What a well system shows, beside the ready-made expectations of the checks: one function an expectation."""

from __future__ import annotations

import math
from pathlib import Path

from ..checks import CannotLook, Expectation, Probe, Seen, expectation, interface, remembered
from ..checks.assertions import node, publishes
from ..checks.navigation import COMMANDS, NAVIGATE, NAVIGATE_TYPE, NEAR, POSE, POSE_TYPE, Drive, drive, where
from ..checks.streams import rate
from ..words import number, point

STATUS, STATUS_TYPE = "/robot/status", "robot_controller/msg/TurtleStatus"
SLOWEST = 10.0
"""Robot time, s, within which a goal in the turtle's world is reached; a longer goal_timeout mends nothing."""


def importable(type_name: str) -> Expectation:
    """A type can be used here."""

    def look(probe: Probe) -> Seen:
        try:
            interface(type_name)
        except CannotLook:
            step = "Named in CMakeLists.txt? Then: colcon build, source install/setup.bash, in the workspace's folder."
            return Seen(False, "no program can use it here", step)
        return Seen(True, "it can be used")

    return Expectation(f"the type {type_name}", look)


def found_in(folder: str, package: str) -> Expectation:
    """A package is found in the workspace of this name, and not elsewhere."""

    def look(probe: Probe) -> Seen:
        from ament_index_python.packages import PackageNotFoundError, get_package_prefix

        try:
            prefix = Path(get_package_prefix(package))
        except PackageNotFoundError:
            return Seen(False, "it is not found at all", "Which step comes after colcon build?")
        if folder in prefix.parts:
            return Seen(True, "it is")
        return Seen(
            False,
            f"it is found in {'/'.join(prefix.parts[-3:])}",
            f"Which setup file was sourced? {folder} has one, too.",
        )

    return Expectation(f"{package} is found in {folder}", look)


def advised(expectation: Expectation, step: str) -> Expectation:
    """The same expectation with another next step: here something is to be found, not written."""

    def look(probe: Probe) -> Seen:
        return expectation.look(probe)._replace(advice=step)

    return Expectation(expectation.expected, look)


def settled(expectation: Expectation) -> Expectation:
    """The same a little later: a timer of a second may have begun before its rate was mended."""

    def look(probe: Probe) -> Seen:
        probe.wait(1.5)
        return expectation.look(probe)

    return Expectation(expectation.expected, look)


def there(name: str, command: str) -> Expectation:
    """One node of this name; `command` starts it."""
    step = (
        f"ros2 node list shows the nodes. One is missing: {command}. There is one too many: jobs and the lines of the "
        "launch tell its pid; kill."
    )
    return advised(node(name), step)


def status_as_specified() -> list[Expectation]:
    """The status: one monitor, the right topic and type, ten messages a second."""
    published = publishes(STATUS, STATUS_TYPE, by="/status_monitor")
    paced = rate(STATUS, STATUS_TYPE, 10.0)
    return [
        there("/status_monitor", "ros2 run robot_controller status_monitor"),
        advised(
            published, f"ros2 topic info {STATUS} --verbose; ros2 node info /status_monitor: what does it publish?"
        ),
        settled(advised(paced, f"ros2 topic hz {STATUS}. Which node publishes it, and what sets its rate?")),
        status_follows,
    ]


def drives(*goals: tuple[float, float]) -> list[Expectation]:
    """The navigator drives the turtle to each of these places, and says so."""
    navigator = there("/navigator", "ros2 run robot_controller navigator")
    return [navigator, answers_at_all(), *(reaches(x, y) for x, y in goals)]


def reaches(x: float, y: float) -> Expectation:
    """A goal is answered with success in reasonable time, and the turtle is there."""

    def look(probe: Probe) -> Seen:
        it = _drive_to(probe, x, y)
        if it.answer.response is None:
            return Seen(False, f"no answer in {it.answer.seconds:g} s", 'lesson.plot_timeline("/navigator")')
        success, end = bool(it.response.success), it.end()
        seen = f"success is {success} after {number(it.answer.seconds)} s, at {point(end.x, end.y)}"
        step = (
            "ros2 topic echo /turtle1/cmd_vel during a call: do commands come, how large, how often, from which node?"
        )
        return Seen(success and it.distance() <= NEAR and it.answer.seconds <= SLOWEST, seen, step)

    return Expectation(f"the goal {point(x, y)} is reached within {SLOWEST:g} s", look)


def commands_steady(x: float, y: float) -> Expectation:
    """On the way to a goal, commands come ten times a second."""

    def look(probe: Probe) -> Seen:
        it = _drive_to(probe, x, y)
        begin, end = it.moving()
        times = [each.at for each in it.commands if begin - 0.2 <= each.at <= end]
        pause = (times[-1] - times[0]) / (len(times) - 1) if len(times) > 1 else end - begin
        step = (
            'lesson.plot_timeline("/turtle1/cmd_vel") after a call. Which node publishes them, and what sets its rate?'
        )
        return Seen(pause <= 0.125, f"one every {number(pause)} s on average", step)

    return Expectation(f"{COMMANDS}: ten commands a second meanwhile", look)


def _drive_to(probe: Probe, x: float, y: float) -> Drive:
    """The drive to a place. Raises CannotLook where the navigator does not answer at all."""
    if not _answers(probe).good:
        raise CannotLook(f"{NAVIGATE} does not answer")
    return drive(probe, f"to {x} {y}", lambda pose: (x, y, 0.0))


def answers_at_all() -> Expectation:
    """Asked to go where the turtle is, the navigator answers, whether the turtle can move or not."""
    return Expectation(f"{NAVIGATE} answers", _answers)


@remembered
def _answers(probe: Probe) -> Seen:
    if not probe.servers(NAVIGATE):
        step = "ros2 node list, ros2 service list: is the node there, and does it offer the service under another name?"
        return Seen(False, f"no node offers it{probe.like(NAVIGATE, probe.services())}", step)
    try:
        here = where(probe)
        x, y, theta = here.x, here.y, here.theta
    except CannotLook:
        x, y, theta = 5.5, 5.5, 0.0
    answer = probe.ask(NAVIGATE, NAVIGATE_TYPE, 30.0, x=x, y=y, theta=theta)
    if answer.response is None:
        step = 'lesson.plot_timeline("/navigator"): which callback holds the thread? lesson.plot_sequence().'
        return Seen(False, "no answer in 30 s", step)
    return Seen(True, f"after {number(answer.seconds)} s")


@expectation(f"{STATUS} says where the turtle is")
def status_follows(probe: Probe) -> Seen:
    """The status says where the turtle is."""
    poses, statuses = probe.listen(POSE, POSE_TYPE), probe.listen(STATUS, STATUS_TYPE)
    probe.wait(0.5)
    if not poses or not statuses:
        raise CannotLook(f"nothing came on {STATUS if poses else POSE}")
    told, true = statuses[-1].message, poses[-1].message
    seen = f"it says {point(told.x, told.y)}, the turtle is at {point(true.x, true.y)}"
    good = math.dist((told.x, told.y), (true.x, true.y)) < 0.3
    return Seen(
        good, seen, "ros2 node info /status_monitor: which topic does it hear, and which node publishes that one?"
    )


@expectation("the battery falls 1 % a second")
def battery_falls(probe: Probe) -> Seen:
    """The battery falls by a tenth of a percent a message, ten times a second."""
    heard = probe.hear(STATUS, STATUS_TYPE, 2.0)
    if len(heard) < 2:
        raise CannotLook(f"nothing came on {STATUS}")
    first, last = heard[0], heard[-1]
    if last.message.battery <= 0.0:
        raise CannotLook("the battery is empty: start the monitor again")
    fall = (first.message.battery - last.message.battery) / (last.at - first.at)
    step = 'lesson.plot_timeline("/status_monitor"): how often is each callback called? ros2 node list: how many?'
    return Seen(abs(fall - 1.0) < 0.1, f"it falls {number(fall, 1)} % a second", step)
