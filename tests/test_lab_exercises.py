"""Small answers to the exercises that the finished package does not hold: met by the right one, missed by a wrong one."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import pytest
from test_lab_checks import program, row

from turtle_lesson import Lesson, start

# isort: split
# Importing turtle_lesson made these importable.
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from std_msgs.msg import Int32


@pytest.fixture
def lesson() -> Lesson:
    return start()


def counter(period: float = 0.5, step: int = 1) -> Any:
    node = rclpy.create_node("counter")
    publisher = node.create_publisher(Int32, "/count", 10)
    sent: list[int] = []

    def count() -> None:
        sent.append(1)
        publisher.publish(Int32(data=step * len(sent)))

    node.create_timer(period, count)
    return node


def test_counter(lesson: Lesson) -> None:
    program(lesson, counter)
    assert lesson.check("counter").passed


def test_counter_that_counts_otherwise(lesson: Lesson) -> None:
    def twice_as_far() -> Any:
        return counter(0.7, 2)

    program(lesson, twice_as_far)
    result = lesson.check("counter")
    assert row(result, "every 500 ms").seen == "every 700.0 ms (1.4 Hz)"
    assert row(result, "changes by 1").seen == "a change of 2"


@pytest.mark.parametrize(("factor", "passed"), [(2, True), (3, False)])
def test_doubler(lesson: Lesson, factor: int, passed: bool) -> None:
    def doubler() -> Any:
        node = rclpy.create_node("doubler")
        publisher = node.create_publisher(Int32, "/doubled", 10)
        node.create_subscription(Int32, "/count", lambda heard: publisher.publish(Int32(data=factor * heard.data)), 10)
        return node

    program(lesson, counter)  # which may well run beside it
    program(lesson, doubler)
    assert lesson.check("doubler").passed == passed


@pytest.mark.parametrize(("sign", "passed"), [(1, True), (-1, False)])
def test_adder(lesson: Lesson, sign: int, passed: bool) -> None:
    def adder() -> Any:
        from example_interfaces.srv import AddTwoInts

        def add(request: Any, response: Any) -> Any:
            response.sum = request.a + sign * request.b
            return response

        node = rclpy.create_node("adder")
        node.create_service(AddTwoInts, "/add_two_ints", add)
        return node

    program(lesson, adder)
    assert lesson.check("adder").passed == passed


@pytest.mark.parametrize("awake", [True, False])
def test_awake(lesson: Lesson, awake: bool) -> None:
    from std_srvs.srv import Trigger

    def main() -> None:
        rclpy.init()
        node = rclpy.create_node("worker")
        publisher = node.create_publisher(Int32, "/heartbeat", 10)
        node.create_timer(0.1, lambda: publisher.publish(Int32()))

        def work(request: Any, response: Any) -> Any:
            time.sleep(2.0)
            response.success = True
            return response

        group = MutuallyExclusiveCallbackGroup() if awake else None
        node.create_service(Trigger, "/work", work, callback_group=group)
        executor = MultiThreadedExecutor()
        executor.add_node(node)
        executor.spin()

    lesson._world.spawn(main, name="worker")
    lesson.run(0.5)
    result = lesson.check("awake")
    assert result.passed == awake
    assert row(result, "takes 1 s").seen == "answered after 2.00 s"
    if not awake:
        assert row(result, "goes on meanwhile").mark == "✗"
        assert row(result, "parameter call").seen == "only when the work was done"


def test_replay(lesson: Lesson, tmp_path: Path) -> None:
    from turtle_lesson.ros.command.shell import run_line

    lesson.launch("robot_controller", "start_system.launch.py")
    assert not lesson.check("replay").passed
    with lesson.record(tmp_path / "bag", ["/robot/status"]):
        lesson.run(5)
    lesson = start()
    run_line(lesson._world, f"ros2 bag play {tmp_path / 'bag'} --loop &")
    lesson.run(1)
    assert lesson.check("replay").passed
