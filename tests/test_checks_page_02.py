"""The check `estimator`: met by a right estimate that also declines, missed by one that does not."""

from __future__ import annotations

import math
from typing import Any

import pytest
from test_lab_checks import program, row

from turtle_lesson import start

# isort: split
# Importing turtle_lesson made this one importable.
import rclpy


def estimate(speed: float, declines: bool) -> Any:
    from robot_controller.srv import NavigateTo

    def on_request(request: Any, response: Any) -> Any:
        inside = 0 <= request.x <= 11.09 and 0 <= request.y <= 11.09
        response.success = inside or not declines
        if response.success:
            response.time_taken = math.hypot(request.x - 5.544445, request.y - 5.544445) / speed
        return response

    node = rclpy.create_node("estimator")
    node.create_service(NavigateTo, "/estimate", on_request)
    return node


@pytest.mark.parametrize(
    ("speed", "declines", "missed"),
    [(0.2, True, []), (0.4, True, ["3 m ahead", "5 m aslant"]), (0.2, False, ["(20, 5)", "(5, −1)"])],
)
def test_estimator(speed: float, declines: bool, missed: list[str]) -> None:
    lesson = start(simulator=False)
    program(lesson, lambda: estimate(speed, declines))
    result = lesson.check("estimator")
    assert result.passed == (not missed)
    assert [each.expected.split(" take ")[0].split(" is ")[0] for each in result.rows if not each.good] == missed
    assert row(result, "where it stands").good
