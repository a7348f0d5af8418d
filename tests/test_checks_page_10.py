"""The checks of page 07, met and missed, and what page 11 advises; the other answers are in answers/."""

from __future__ import annotations

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.ros.command.shell import run_line


@pytest.fixture
def lesson() -> Lesson:
    return start()


def test_on_site_without_any_node_asks_for_one_launch(lesson: Lesson) -> None:
    result = lesson.check("on_site")
    steps = [each.advice.direction for each in result.rows if each.expected.startswith("one node")]
    assert len(steps) == 3
    assert all("ros2 launch robot_controller start_system.launch.py" in step for step in steps)
    assert not any("ros2 run" in step for step in steps)


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
