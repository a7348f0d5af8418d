"""The checks of page 04: batteries that are right and wrong, and a node that watches one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.lab.checks import CheckResult

# isort: split
# Importing turtle_lesson made these importable.
import rclpy
from std_msgs.msg import Bool


def row(result: CheckResult, expected: str) -> Any:
    return next(each for each in result.rows if expected in each.expected)


def monitor(drain: Callable[[float], float], period: float = 0.1) -> tuple[Lesson, Any]:
    lesson = start()
    from robot_controller.msg import TurtleStatus

    rclpy.init()
    node = rclpy.create_node("status_monitor")
    publisher = node.create_publisher(TurtleStatus, "/robot/status", 10)
    status = TurtleStatus(battery=100.0)

    def on_timer() -> None:
        publisher.publish(status)
        status.battery = drain(status.battery)

    node.create_timer(period, on_timer)
    return lesson, node


def test_the_finished_monitor_has_a_battery() -> None:
    lesson = start()
    lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(1)
    result = lesson.check("battery")
    assert result.passed, result


def test_a_battery_that_ends_at_zero() -> None:
    lesson, _node = monitor(lambda charge: max(0.0, charge - 0.1))
    result = lesson.check("battery")
    assert result.passed, result


@pytest.mark.parametrize(
    ("drain", "wrong"),
    [
        (lambda charge: charge, {"falls", "ends"}),
        (lambda charge: charge - 0.1, {"ends"}),
        (lambda charge: max(0.0, charge - 0.2), {"falls"}),
        (lambda charge: max(1.0, charge - 0.1), {"ends"}),
    ],
)
def test_batteries_that_are_wrong(drain: Callable[[float], float], wrong: set[str]) -> None:
    lesson, _node = monitor(drain)
    result = lesson.check("battery")
    assert {each.expected.split()[1] for each in result.rows if each.mark == "✗"} == wrong, result


def test_a_battery_at_another_rate() -> None:
    lesson, _node = monitor(lambda charge: max(0.0, charge - 0.1), period=0.2)
    result = lesson.check("battery")
    assert row(result, "a message every").mark == "✗"


@pytest.mark.parametrize(
    ("low", "passed"),
    [
        (lambda charge: charge < 20.0, True),
        (lambda charge: charge <= 20.0, False),
        (lambda charge: False, False),
        (lambda charge: charge > 20.0, False),
    ],
)
def test_a_watch(low: Callable[[float], bool], passed: bool) -> None:
    lesson = start()
    from robot_controller.msg import TurtleStatus

    rclpy.init()
    node = rclpy.create_node("battery_watch")
    publisher = node.create_publisher(Bool, "/robot/battery_low", 10)
    node.create_subscription(
        TurtleStatus, "/robot/status", lambda status: publisher.publish(Bool(data=low(status.battery))), 10
    )
    result = lesson.check("battery_watch")
    assert result.passed == passed, result
