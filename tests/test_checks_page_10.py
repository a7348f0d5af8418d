"""The checks of pages 00, 07, 10 and 11: met by a right answer, missed by a wrong one."""

from __future__ import annotations

import math
from typing import Any

import pytest
from test_lab_checks import marks, program, row

from turtle_lesson import Lesson, start
from turtle_lesson.ros.command.shell import run_line

# isort: split
# Importing turtle_lesson made these importable.
import rclpy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool


@pytest.fixture
def lesson() -> Lesson:
    return start()


def within(status: Any) -> bool:
    return bool(0 <= status.battery <= 100)


def not_without(status: Any) -> bool:
    return not (status.battery < 0 or status.battery > 100)


@pytest.mark.parametrize(
    ("judge", "seen"),
    [(within, "✓✓✓✓✓"), (not_without, "✓✓✓✓✗"), (lambda _: True, "✓✓✓✗✗"), (lambda _: False, "✓✓✗✓✓")],
)
def test_battery_test(lesson: Lesson, judge: Any, seen: str) -> None:
    def tester() -> Any:
        from robot_controller.msg import TurtleStatus

        node = rclpy.create_node("tester")
        verdicts = node.create_publisher(Bool, "/tests/battery", 10)
        node.create_subscription(TurtleStatus, "/robot/status", lambda it: verdicts.publish(Bool(data=judge(it))), 10)
        return node

    program(lesson, tester)
    assert marks(lesson.check("battery_test")) == seen


def watchdog(limit: float) -> Any:
    from robot_controller.msg import TurtleStatus

    node = rclpy.create_node("watchdog")
    heard = [-math.inf]

    def seconds() -> float:
        return node.get_clock().now().nanoseconds / 1e9

    alive = node.create_publisher(Bool, "/tests/alive", 10)
    node.create_subscription(TurtleStatus, "/robot/status", lambda _: heard.append(seconds()), 10)
    node.create_timer(0.2, lambda: alive.publish(Bool(data=seconds() - heard[-1] < limit)))
    return node


@pytest.mark.parametrize(("limit", "seen"), [(0.5, "✓✓✓✓✓"), (1e6, "✓✓✓✗✓"), (0.0, "✓✓✗✓✗")])
def test_watchdog(lesson: Lesson, limit: float, seen: str) -> None:
    def dog() -> Any:
        return watchdog(limit)

    program(lesson, dog)
    assert marks(lesson.check("watchdog")) == seen


def test_watchdog_beside_a_status_monitor(lesson: Lesson) -> None:
    def dog() -> Any:
        return watchdog(0.5)

    program(lesson, dog)
    lesson.launch("robot_controller", "start_system.launch.py")
    assert "/status_monitor publishes /robot/status" in row(lesson.check("watchdog"), "silence").seen


def test_on_site(lesson: Lesson) -> None:
    wanted = {"goal_timeout": 8.0, "publish_rate": 20, "source": "world"}
    lesson.launch("robot_controller", "start_system.launch.py", **wanted)
    assert lesson.check("on_site").passed


def test_on_site_without_any_node_asks_for_one_launch(lesson: Lesson) -> None:
    result = lesson.check("on_site")
    steps = [each.advice.direction for each in result.rows if each.expected.startswith("one node")]
    assert len(steps) == 3
    assert all("ros2 launch robot_controller start_system.launch.py" in step for step in steps)
    assert not any("ros2 run" in step for step in steps)


@pytest.mark.parametrize(("near", "age", "seen"), [(0.5, 0.5, "✓" * 7), (0.5, 1e6, "✓✓✓✓✓✓✗"), (0.0, 0.5, "✓✓✓✓✗✓✓")])
def test_safety_stop(lesson: Lesson, near: float, age: float, seen: str) -> None:
    def safety_stop() -> Any:
        node = rclpy.create_node("safety_stop")
        commands = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        last = [(0.0, -math.inf)]

        def now() -> float:
            return node.get_clock().now().nanoseconds / 1e9

        def on_wanted(wanted: Any) -> None:
            distance, at = last[-1]
            commands.publish(wanted if distance >= near and now() - at <= age else Twist())

        node.create_subscription(LaserScan, "/obstacles", lambda scan: last.append((min(scan.ranges), now())), 10)
        node.create_subscription(Twist, "/wanted_vel", on_wanted, 10)
        return node

    program(lesson, safety_stop)
    assert marks(lesson.check("safety_stop")) == seen


SPAWN = 'ros2 service call /spawn turtlesim/srv/Spawn "{x: 2.0, y: %s, name: turtle2}"'
DRIVE = (
    'ros2 topic pub --rate 10 --print 100 /turtle1/cmd_vel geometry_msgs/Twist "{linear: {x: 1.0}, angular: {z: %s}}" &'
)
GO = 'ros2 service call /navigate_to robot_controller/srv/NavigateTo "{x: 2.0, y: %s}"'


@pytest.mark.parametrize(
    ("name", "right", "wrong"),
    [
        ("tuned", "ros2 param set /status_monitor publish_rate 20", "ros2 param set /status_monitor publish_rate 21"),
        ("second_turtle", SPAWN % 9.0, SPAWN % 2.0),
        ("circle", DRIVE % 0.5, DRIVE % 0.0),
        ("corner", GO % 2.0, GO % 3.0),
    ],
)
def test_by_command(name: str, right: str, wrong: str) -> None:
    for command, passed in ((right, True), (wrong, False)):
        lesson = start()
        lesson.launch("robot_controller", "start_system.launch.py")
        assert not lesson.check(name).passed
        run_line(lesson._world, command)
        lesson.run(0.5)
        assert lesson.check(name).passed == passed
