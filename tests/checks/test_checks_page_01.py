"""The check `reporter` where there is no turtle; what it says of answers is in `answers/page_01.py`."""

from __future__ import annotations

from typing import Any

from test_lab_checks import program, row

from turtle_lesson import start

# isort: split
# Importing turtle_lesson made these importable.
import rclpy
from std_msgs.msg import Float32
from turtlesim.msg import Pose


def report(xs: list[float], which: Any) -> Any:
    """A node that reports one of the xs that it has heard."""
    node = rclpy.create_node("reporter")
    publisher = node.create_publisher(Float32, "/report", 10)
    node.create_subscription(Pose, "/turtle1/pose", lambda pose: xs.append(pose.x), 10)
    node.create_timer(1.0, lambda: publisher.publish(Float32(data=which(xs))))
    return node


def test_reporter_without_a_turtle() -> None:
    lesson = start(package=None, simulator=False)
    program(lesson, lambda: report([5.5], lambda xs: xs[-1]))
    assert row(lesson.check("reporter"), "the newest x").seen == (
        "not looked at, because no node publishes /turtle1/pose"
    )
