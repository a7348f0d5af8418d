"""What a well system shows, beside the ready-made expectations of the checks: one function an expectation."""

from __future__ import annotations

import math
from collections.abc import Callable

from ..checks import CannotLook, Exam, Expectation, Seen, interface
from ..checks.drives import NAVIGATE, NAVIGATE_TYPE, POSE, POSE_TYPE, answered, arrived, where
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


def status_as_specified() -> list[Expectation]:
    """The status: one monitor, the right topic and type, ten messages a second."""
    monitor = node("/status_monitor", "ros2 run robot_controller status_monitor")
    return [monitor, publishes(STATUS, STATUS_TYPE, by="/status_monitor"), rate(STATUS, STATUS_TYPE, 10.0)]


def drives(*goals: tuple[float, float]) -> list[Expectation]:
    """The navigator drives the turtle to each of these places, and says so."""
    rows: list[Expectation] = [node("/navigator", "ros2 run robot_controller navigator"), answers_at_all()]
    for x, y in goals:
        name = f"goal {point(x, y)}"
        rows += [answered(name, _to(x, y)), arrived(name, _to(x, y))]
    return rows


def _to(x: float, y: float) -> Callable[[object], tuple[float, float, float]]:
    return lambda pose: (x, y, 0.0)


def answers_at_all() -> Expectation:
    """A goal outside of the world is answered, whether the turtle can move or not."""

    def look(exam: Exam) -> Seen:
        if not exam.servers(NAVIGATE):
            step = "ros2 node list, ros2 service list: is its node there, and does it offer another name?"
            return Seen(False, f"nobody offers it{exam.like(NAVIGATE, exam.services())}", step)
        here = exam.once(("here",), lambda: where(exam)) if exam.publishers(POSE) else None
        x, y = (here.x, here.y) if here is not None else (5.5, 5.5)
        answer = exam.ask(NAVIGATE, NAVIGATE_TYPE, 30.0, x=x, y=y, theta=0.0)
        if answer.response is None:
            step = 'lesson.plot_timeline("/navigator"): which callback holds the thread? lesson.plot_sequence().'
            return Seen(False, "no answer in 30 s", step)
        return Seen(True, f"after {number(answer.seconds)} s")

    return Expectation(f"{NAVIGATE} answers", look)


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
