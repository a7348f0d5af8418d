"""The checks of page 04 beside the answers in tests/answers: the finished monitor, and what only another node can do wrong."""

from __future__ import annotations

import re
from typing import Any

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.lab.checks.results import CheckResult

# isort: split
# Importing turtle_lesson made these importable.
import rclpy
from std_msgs.msg import Bool


def row(result: CheckResult, expected: str) -> Any:
    return next(each for each in result.rows if expected in each.expected)


def finished_monitor() -> Lesson:
    lesson = start()
    lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(1)
    return lesson


def test_the_finished_monitor_passes() -> None:
    lesson = finished_monitor()
    assert lesson.check("status_monitor").passed
    assert lesson.check("battery").passed


@pytest.mark.parametrize(
    ("fields", "off"),
    [("x", ("y", "theta")), ("y", ("x", "theta")), ("xy", ("theta",)), ("", ("x", "y", "theta"))],
)
def test_a_pose_that_is_reported_in_part(fields: str, off: tuple[str, ...]) -> None:
    lesson = start()
    from robot_controller.msg import TurtleStatus
    from turtlesim.msg import Pose

    rclpy.init()
    node = rclpy.create_node("status_monitor")
    publisher = node.create_publisher(TurtleStatus, "/robot/status", 10)
    status = TurtleStatus(battery=100.0)

    def on_pose(pose: Any) -> None:
        for name in fields:
            setattr(status, name, getattr(pose, name))

    node.create_subscription(Pose, "/turtle1/pose", on_pose, 1)
    node.create_timer(0.1, lambda: publisher.publish(status))
    follows = row(lesson.check("status_monitor"), "x, y, theta")
    assert follows.mark == "✗"
    x, y, theta = (float(each) for each in re.findall(r"[0-9.]+(?= m| rad)", follows.seen))
    assert {name for name, amount in (("x", x), ("y", y), ("theta", theta)) if amount > 0.1} == set(off)


def test_a_battery_at_another_rate() -> None:
    lesson = start()
    from robot_controller.msg import TurtleStatus

    rclpy.init()
    node = rclpy.create_node("status_monitor")
    publisher = node.create_publisher(TurtleStatus, "/robot/status", 10)
    node.create_timer(0.2, lambda: publisher.publish(TurtleStatus(battery=100.0)))
    assert row(lesson.check("battery"), "a message every").mark == "✗"


def test_a_watch_is_asked_only_where_no_monitor_runs() -> None:
    lesson = finished_monitor()
    rclpy.init()
    node = rclpy.create_node("battery_watch")
    node.create_publisher(Bool, "/robot/battery_low", 10)
    asked = row(lesson.check("battery_watch"), "True below 20 %")
    assert asked.mark == "–"
    assert "/status_monitor publishes /robot/status" in asked.seen
