"""The checks of page 03, and how functions that a learner wrote are found and called."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from turtle_lesson import Lesson, start
from turtle_lesson.lab.checks.assertions import learner_function, returns
from turtle_lesson.lab.checks.probe import Probe
from turtle_lesson.lab.checks.registry import Expectation
from turtle_lesson.lab.checks.results import CannotLook, CheckResult
from turtle_lesson.learner.workspace import workspace
from turtle_lesson.session.check_target import CheckTarget

# isort: split
# Importing turtle_lesson made these importable.
import rclpy
from geometry_msgs.msg import Twist
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.task import Future
from test_simple_stage import in_our_words
from turtlesim.msg import Pose


def row(result: CheckResult, expected: str) -> Any:
    return next(each for each in result.rows if expected in each.expected)


# -- navigators --------------------------------------------------------------------------------------------------------


class OnArrival(Node):
    """A navigator in a cell that answers on arrival, by a coroutine; it refuses nothing."""

    def __init__(self) -> None:
        from robot_controller.srv import NavigateTo

        super().__init__("navigator")
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
        self.get_logger().info(f"{request}")
        self.goal, self.arrived = request, Future()
        response.success = await self.arrived
        return response

    def on_timer(self) -> None:
        if self.goal is None or self.pose is None:
            return
        dx, dy = self.goal.x - self.pose.x, self.goal.y - self.pose.y
        command = Twist()
        there = math.hypot(dx, dy) < 0.1
        turn = math.remainder((self.goal.theta if there else math.atan2(dy, dx)) - self.pose.theta, math.tau)
        if there and abs(turn) < 0.05:
            self.goal = None
            self.arrived.set_result(True)
        else:
            command.linear.x = 1.0 if not there and abs(turn) < 0.3 else 0.0
            command.angular.z = 2.0 * turn
        self.commands.publish(command)


def test_a_coroutine_in_a_cell_goes_on_from_step_to_step(capsys: pytest.CaptureFixture[str]) -> None:
    lesson = start()
    rclpy.init()
    node = OnArrival()
    result = lesson.check("navigator")
    assert row(result, "a goal: the turtle within").good
    assert row(result, "another in the west").good
    assert row(result, "x outside").seen == "(20, 5, 0): no answer in 5 s"
    node.destroy_node()


def test_the_simple_stage_is_no_navigator(tmp_path: Path) -> None:
    lesson = start(package=in_our_words(tmp_path))
    lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(1)
    result = lesson.check("navigator")
    assert row(result, "a goal: success").mark == "✗"
    assert row(result, "in the west").mark == "✗"


# -- functions ---------------------------------------------------------------------------------------------------------


class Looking(Probe):
    """A probe of a fresh world."""

    def __init__(self, lesson: Lesson) -> None:
        super().__init__(CheckTarget(lesson._world, lesson._recording, lesson._board), limit=10)


@pytest.fixture
def probe() -> Iterator[Probe]:
    with Looking(start()) as probe:
        yield probe


@pytest.fixture
def cells() -> Iterator[dict[str, Any]]:
    """The names of the notebook's cells."""
    names = vars(sys.modules["__main__"])
    before = dict(names)
    yield names
    names.clear()
    names.update(before)


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file of the learner's package that does not exist yet."""
    monkeypatch.chdir(tmp_path)
    folder = workspace().package / "robot_controller"
    folder.mkdir(parents=True)
    return folder / "node.py"


def look(probe: Probe, expectation: Expectation) -> tuple[bool, str]:
    good, words, _ = expectation.look(probe)
    return good, words


def test_a_function_of_a_cell(probe: Probe, cells: dict[str, Any]) -> None:
    cells["double"] = lambda x: 2 * x
    assert look(probe, returns("double", [((3,), 6)], "twice")) == (True, "double(3) is 6")
    assert look(probe, returns("double", [((3,), 6), ((0.5,), 2.0)], "twice")) == (False, "double(0.5) is 1.0, not 2.0")


def test_a_number_may_be_a_little_off_but_not_nan(probe: Probe, cells: dict[str, Any]) -> None:
    cells["root"] = math.sqrt
    assert look(probe, returns("root", [((2.0,), 1.414)], "root", within=0.001))[0]
    assert not look(probe, returns("root", [((2.0,), 1.414)], "root", within=0.0001))[0]
    cells["root"] = lambda x: math.nan
    assert look(probe, returns("root", [((2.0,), 1.414)], "root", within=9.0)) == (False, "root(2.0) is nan, not 1.414")


def test_true_is_not_one_and_nothing_is_not_false(probe: Probe, cells: dict[str, Any]) -> None:
    cells["it"] = lambda x: x
    assert not look(probe, returns("it", [((1,), True)], "it"))[0]
    assert not look(probe, returns("it", [((True,), 1)], "it"))[0]
    assert look(probe, returns("it", [((None,), False)], "it")) == (False, "it(None) is None, not False")


def test_a_function_that_is_not_there(probe: Probe, cells: dict[str, Any]) -> None:
    cells["turn_too"] = abs
    with pytest.raises(CannotLook, match=r'no function turn_to in this notebook\. Did you mean "turn_too"'):
        learner_function(probe, "turn_to")
    cells["turn_to"] = 3
    with pytest.raises(CannotLook, match=r"no function turn_to in this notebook"):
        learner_function(probe, "turn_to")


def test_a_function_of_a_file(file: Path) -> None:
    file.write_text('def one():\n    return 1\n\nif __name__ == "__main__":\n    raise SystemExit\n')
    with Looking(start()) as probe:
        assert learner_function(probe, "one", "node.py")() == 1
        with pytest.raises(CannotLook, match=r"no function two in node\.py of your package"):
            learner_function(probe, "two", "node.py")


def test_a_file_that_is_missing_or_no_python(file: Path) -> None:
    with (
        Looking(start()) as probe,
        pytest.raises(CannotLook, match=r"no file workspace/src/robot_controller/robot_contr"),
    ):
        learner_function(probe, "one", "node.py")
    file.write_text("def one(:\n")
    with Looking(start()) as probe, pytest.raises(SyntaxError):
        learner_function(probe, "one", "node.py")
