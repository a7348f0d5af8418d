"""What a well system shows, beside the ready-made expectations of the checks: one function an expectation."""

from __future__ import annotations

import math

from ..checks import CannotLook, Exam, Expectation, Seen, interface
from ..checks.drives import NAVIGATE, NAVIGATE_TYPE, NEAR, POSE, POSE_TYPE, drive, where
from ..checks.parts import node, publishes
from ..checks.streams import rate
from ..words import number, point

STATUS, STATUS_TYPE = "/robot/status", "robot_controller/msg/TurtleStatus"


def importable(type_name: str) -> Expectation:
    """A type can be used here."""

    def look(exam: Exam) -> Seen:
        try:
            interface(type_name)
        except CannotLook:
            step = "Named in CMakeLists.txt? Then: colcon build, source install/setup.bash, in the workspace's folder."
            return Seen(False, "nobody can use it here", step)
        return Seen(True, "it can be used")

    return Expectation(f"the type {type_name}", look)


def advised(expectation: Expectation, step: str) -> Expectation:
    """The same expectation with another next step: here something is to be found, not written."""

    def look(exam: Exam) -> Seen:
        return expectation.look(exam)._replace(advice=step)

    return Expectation(expectation.expected, look)


def there(name: str, command: str) -> Expectation:
    """One node of this name; `command` starts it."""
    step = f"ros2 node list shows who is there. Too few: {command}. Too many: jobs, and the pids that a launch tells; kill."
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
        advised(paced, f"ros2 topic hz {STATUS}; who publishes it, from which callback, and at a rate set by what?"),
    ]


def drives(*goals: tuple[float, float]) -> list[Expectation]:
    """The navigator drives the turtle to each of these places, and says so."""
    navigator = there("/navigator", "ros2 run robot_controller navigator")
    return [navigator, answers_at_all(), *(reaches(x, y) for x, y in goals)]


def reaches(x: float, y: float) -> Expectation:
    """A goal is answered with success, and the turtle is there."""

    def look(exam: Exam) -> Seen:
        if not exam.once(("answers",), lambda: _answers(exam)).good:
            raise CannotLook(f"{NAVIGATE} does not answer")
        it = drive(exam, f"to {x} {y}", lambda pose: (x, y, 0.0))
        if it.answer.response is None:
            return Seen(False, f"no answer in {it.answer.seconds:g} s", 'lesson.plot_timeline("/navigator")')
        success, end = bool(it.response.success), it.end()
        seen = f"success is {success} after {number(it.answer.seconds)} s, at {point(end.x, end.y)}"
        step = (
            "During a call: ros2 topic echo /turtle1/cmd_vel. Do commands come, how large, how often, who hears them?"
        )
        return Seen(success and it.distance() <= NEAR, seen, step)

    return Expectation(f"the goal {point(x, y)} is reached", look)


def answers_at_all() -> Expectation:
    """Asked to go where the turtle is, the navigator answers, whether the turtle can move or not."""
    return Expectation(f"{NAVIGATE} answers", lambda exam: exam.once(("answers",), lambda: _answers(exam)))


def _answers(exam: Exam) -> Seen:
    if not exam.servers(NAVIGATE):
        step = "ros2 node list, ros2 service list: is its node there, and does it offer another name?"
        return Seen(False, f"nobody offers it{exam.like(NAVIGATE, exam.services())}", step)
    try:
        here = where(exam)
        x, y, theta = here.x, here.y, here.theta
    except CannotLook:
        x, y, theta = 5.5, 5.5, 0.0
    answer = exam.ask(NAVIGATE, NAVIGATE_TYPE, 30.0, x=x, y=y, theta=theta)
    if answer.response is None:
        step = 'lesson.plot_timeline("/navigator"): which callback holds the thread? lesson.plot_sequence().'
        return Seen(False, "no answer in 30 s", step)
    return Seen(True, f"after {number(answer.seconds)} s")


def status_follows() -> Expectation:
    """The status tells where the turtle is."""

    def look(exam: Exam) -> Seen:
        poses, statuses = exam.listen(POSE, POSE_TYPE), exam.listen(STATUS, STATUS_TYPE)
        exam.wait(0.5)
        if not poses or not statuses:
            raise CannotLook(f"nothing came on {STATUS if poses else POSE}")
        told, true = statuses[-1].message, poses[-1].message
        seen = f"it tells {point(told.x, told.y)}, the turtle is at {point(true.x, true.y)}"
        good = math.dist((told.x, told.y), (true.x, true.y)) < 0.3
        return Seen(good, seen, "ros2 node info /status_monitor: which topic does it hear, and who publishes that one?")

    return Expectation(f"{STATUS} tells where the turtle is", look)


def battery_falls() -> Expectation:
    """The battery falls by a tenth of a percent a message, ten times a second."""

    def look(exam: Exam) -> Seen:
        heard = exam.hear(STATUS, STATUS_TYPE, 2.0)
        if len(heard) < 2:
            raise CannotLook(f"nothing came on {STATUS}")
        first, last = heard[0], heard[-1]
        if last.message.battery <= 0.0:
            raise CannotLook("the battery is empty: start the monitor again")
        fall = (first.message.battery - last.message.battery) / (last.at - first.at)
        step = 'lesson.plot_timeline("/status_monitor"): how often is each callback called? ros2 node list: how many?'
        return Seen(abs(fall - 1.0) < 0.1, f"it falls {number(fall, 1)} % a second", step)

    return Expectation("the battery falls 1 % a second", look)
