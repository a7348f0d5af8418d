"""The check `reporter`: met by who reports the newest x, missed by who is late, or says always the same."""

from __future__ import annotations

from typing import Any

import pytest
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


@pytest.mark.parametrize(
    ("which", "passed"),
    [
        (lambda xs: xs[-1], True),
        (lambda xs: xs[0], False),
        (lambda xs: xs[max(0, len(xs) - 60)], False),
        (lambda xs: 5.544445, False),
    ],
    ids=["newest", "first", "a second late", "a constant"],
)
def test_reporter(which: Any, passed: bool) -> None:
    lesson = start(package=None)
    program(lesson, lambda: report([], which))
    result = lesson.check("reporter")
    assert result.passed == passed
    news = row(result, "the newest x")
    assert news.seen.startswith("it said ")
    assert bool(news.advice.direction) != passed


def test_reporter_without_a_turtle() -> None:
    lesson = start(package=None, simulator=False)
    program(lesson, lambda: report([5.5], lambda xs: xs[-1]))
    assert row(lesson.check("reporter"), "the newest x").seen == (
        "not looked at, because nobody publishes /turtle1/pose"
    )
