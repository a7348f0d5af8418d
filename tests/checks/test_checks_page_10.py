"""What page 11 advises, and the check of a goal; the other answers are in answers/."""

from __future__ import annotations

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.ros.cli.shell import run_line


@pytest.fixture
def lesson() -> Lesson:
    return start()


def test_on_site_without_any_node_asks_for_one_launch(lesson: Lesson) -> None:
    result = lesson.check("on_site")
    steps = [each.advice.direction for each in result.rows if each.expected.startswith("one node")]
    assert len(steps) == 3
    assert all("ros2 launch robot_controller start_system.launch.py" in step for step in steps)
    assert not any("ros2 run" in step for step in steps)


GO = 'ros2 service call /navigate_to robot_controller/srv/NavigateTo "{x: 2.0, y: %s}"'


@pytest.mark.parametrize(("y", "passed"), [(2.0, True), (3.0, False)])
def test_a_goal_in_the_corner(lesson: Lesson, y: float, passed: bool) -> None:
    lesson.launch("robot_controller", "start_system.launch.py")
    assert not lesson.check("corner").passed
    run_line(lesson._world, GO % y)
    lesson.run(0.5)
    assert lesson.check("corner").passed == passed
