"""The checks of page 09: each is about its own case, and met by what the page's solution types."""

from __future__ import annotations

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.ros.command.shell import run_line

CASES = {
    "slow_case": (1, "turtle stands still", ["ros2 param set /navigator command_period 0.1"]),
    "deaf_case": (
        0,
        "alarm stays silent",
        ["kill -INT 1005 && ros2 run robot_draft obstacle_alarm --ros-args -p reliability:=best_effort"],
    ),
    "own_case": (7, None, ["kill -INT 1004 && ros2 run robot_controller status_monitor"]),
}


def opened(check: str) -> Lesson:
    seed, name, _ = CASES[check]
    lesson = start()
    lesson.trouble(seed, name=name)
    return lesson


@pytest.mark.parametrize("check", CASES)
def test_a_case_is_missed_before_its_mend_and_met_after_it(check: str) -> None:
    lesson = opened(check)
    assert not lesson.check(check).passed
    for command in CASES[check][2]:
        run_line(lesson._world, command)
    assert lesson.check(check).passed
    assert lesson.check("trouble").passed


@pytest.mark.parametrize("check", CASES)
def test_another_case_does_not_count(check: str) -> None:
    other = next(each for each in CASES if each != check)
    lesson = opened(other)
    for command in CASES[other][2]:
        run_line(lesson._world, command)
    result = lesson.check(check)
    assert not result.passed
    assert "Another one is asked for" in result.rows[0].advice.direction


@pytest.mark.parametrize("check", CASES)
def test_without_a_case_it_says_which_one_to_open(check: str) -> None:
    opened(check)
    assert "there is none in this world yet" in repr(start().check(check))
