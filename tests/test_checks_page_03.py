"""The checks of page 03: what they say of navigators that turn the long way, turn the short way, or refuse nothing."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.lab.checks import CheckResult

# isort: split
# Importing turtle_lesson made these importable.
import rclpy
from geometry_msgs.msg import Twist
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.task import Future
from test_simple_stage import in_our_words
from turtlesim.msg import Pose

Turn = Callable[[float, float], float]


def the_long_way(wanted: float, heading: float) -> float:
    return wanted - heading


def the_short_way(wanted: float, heading: float) -> float:
    return math.remainder(wanted - heading, math.tau)


class Navigator(Node):
    """A navigator as a reader writes it in a cell: a timer steers, and a coroutine answers."""

    def __init__(self, turn_to: Turn) -> None:
        from robot_controller.srv import NavigateTo

        super().__init__("navigator")
        self.turn_to = turn_to
        self.pose: Any = None
        self.goal: Any = None
        self.arrived = Future()
        self.commands = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 1)
        group = ReentrantCallbackGroup()
        self.create_service(NavigateTo, "/navigate_to", self.on_goal, callback_group=group)
        self.create_timer(0.1, self.on_timer)

    def on_pose(self, pose: Any) -> None:
        self.pose = pose

    async def on_goal(self, request: Any, response: Any) -> Any:
        began = self.get_clock().now()
        self.goal, self.arrived = request, Future()
        self.on_timer()
        response.success = await self.arrived
        response.time_taken = (self.get_clock().now() - began).nanoseconds / 1e9
        return response

    def on_timer(self) -> None:
        if self.goal is None or self.pose is None:
            return
        dx, dy = self.goal.x - self.pose.x, self.goal.y - self.pose.y
        command = Twist()
        there = math.hypot(dx, dy) < 0.1
        turn = self.turn_to(self.goal.theta if there else math.atan2(dy, dx), self.pose.theta)
        if there and abs(turn) < 0.05:
            self.goal = self.arrived.set_result(True)
        else:
            command.linear.x = 1.0 if not there and abs(turn) < 0.3 else 0.0
            command.angular.z = 2.0 * turn
        self.commands.publish(command)


def in_a_cell(turn_to: Turn, kind: type[Navigator] = Navigator) -> tuple[Lesson, Navigator]:
    lesson = start()
    rclpy.init()
    return lesson, kind(turn_to)


def row(result: CheckResult, expected: str) -> Any:
    return next(each for each in result.rows if expected in each.expected)


def test_the_finished_navigator_turns_the_short_way() -> None:
    lesson = start()
    lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(1)
    result = lesson.check("short_way")
    assert result.passed, result


def test_a_coroutine_in_a_cell_goes_on_from_step_to_step_and_the_short_way_is_seen() -> None:
    lesson, _node = in_a_cell(the_short_way)
    result = lesson.check("short_way")
    assert result.passed, result


def test_pirouettes_are_counted() -> None:
    lesson, _node = in_a_cell(the_long_way)
    result = lesson.check("short_way")
    assert row(result, "the turtle within").good
    assert row(result, "turns of 400°").mark == "✗"
    assert "math.remainder" in row(result, "turns of 400°").advice.direction


def test_what_refuses_nothing_is_no_navigator_yet(capsys: pytest.CaptureFixture[str]) -> None:
    lesson, _node = in_a_cell(the_short_way)
    result = lesson.check("navigator")
    assert row(result, "outside the world").seen == "no answer in 5 s"
    assert row(result, "no number").seen == "not looked at, because the goal (20.00, 5.00) was not refused"
    assert [each.expected for each in result.rows if not each.good] == [
        "refuses a goal outside the world",
        "refuses a goal that is no number",
    ]
    assert "[ERROR]" not in capsys.readouterr().out


class WithinTheWorld(Navigator):
    """Refuses what is outside the world, by a comparison that lets pass what is no number."""

    async def on_goal(self, request: Any, response: Any) -> Any:
        if request.x > 11.09 or request.y > 11.09:
            return response
        return await super().on_goal(request, response)


def test_a_goal_that_is_no_number_is_looked_at_once_one_outside_is_refused() -> None:
    lesson, _node = in_a_cell(the_short_way, WithinTheWorld)
    result = lesson.check("navigator")
    assert row(result, "outside the world").good
    assert row(result, "no number").seen == "no answer in 5 s"
    assert "turtlesim" in row(result, "no error").seen


@pytest.mark.parametrize(("name", "passed"), [("simple_navigator", True), ("short_way", False)])
def test_the_simple_stage(tmp_path: Path, name: str, passed: bool) -> None:
    lesson = start(package=in_our_words(tmp_path))
    lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(1)
    result = lesson.check(name)
    assert result.passed == passed, result
    if not passed:
        assert row(result, "turns of").seen == "not looked at, because the turtle never turned"
