"""The action /turtle1/rotate_absolute, against what a real turtlesim printed, and its source where nothing is recorded."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy
from action_msgs.msg import GoalStatus
from hypothesis import given
from hypothesis import strategies as st
from rclpy.action import ActionClient
from test_turtlesim_node import Bench
from turtlesim.action import RotateAbsolute
from turtlesim.msg import Pose
from turtlesim.srv import Kill, Spawn

from turtle_lesson.turtlesim.turtle import PI, TICK, Rotation, TurtleWorld, float32, normalized

RECORDED = Path(__file__).parents[3] / "shared" / "golden" / "turtlesim_cli.txt"
STARTED = 2  # lines of the log


@pytest.fixture
def bench() -> Iterator[Bench]:
    bench = Bench()
    yield bench
    bench.world.close()


class Turner:
    """A client of a turtle's action, in a cell."""

    def __init__(self, bench: Bench, turtle: str = "turtle1") -> None:
        self.node = bench.node
        self.client = ActionClient(bench.node, RotateAbsolute, f"/{turtle}/rotate_absolute")
        assert self.client.wait_for_server(timeout_sec=1.0)
        self.heard: list[float] = []

    def send(self, theta: float) -> Any:
        """Send a goal; returns its handle."""
        future = self.client.send_goal_async(RotateAbsolute.Goal(theta=theta), self._hear)
        rclpy.spin_until_future_complete(self.node, future)
        return future.result()

    def outcome(self, goal: Any) -> tuple[int, float]:
        """A goal's status and the angle in its result, once it has ended."""
        future = goal.get_result_async()
        rclpy.spin_until_future_complete(self.node, future)
        return future.result().status, future.result().result.delta

    def _hear(self, message: Any) -> None:
        self.heard.append(message.feedback.remaining)


def test_a_quarter_turn_gives_the_recorded_feedback_and_result(bench: Bench) -> None:
    turner = Turner(bench)
    poses = bench.listen(Pose, "/turtle1/pose")
    goal = turner.send(1.57)
    assert turner.outcome(goal) == (GoalStatus.STATUS_SUCCEEDED, -1.5520000457763672)  # recorded
    assert len(turner.heard) == 98
    assert (turner.heard[0], turner.heard[1], turner.heard[-1]) == (
        1.5700000524520874,
        1.5540000200271606,
        0.018000006675720215,
    )
    if RECORDED.exists():
        assert turner.heard == [float(each) for each in re.findall(r"remaining: (\S+)", RECORDED.read_text())]
    bench.run(0.1)
    assert bench.log()[STARTED:] == ["[INFO]: Rotation goal completed successfully"]
    turning = [pose for pose in poses if pose.angular_velocity]
    assert {pose.angular_velocity for pose in turning} == {1.0} and len(turning) == 97
    assert (poses[-1].theta, poses[-1].angular_velocity) == (float32(1.552), 0.0)
    assert poses[-1].x == poses[0].x


def test_it_turns_the_shorter_way_round(bench: Bench) -> None:
    turner = Turner(bench)
    turner.outcome(turner.send(2.8))
    turner.heard.clear()
    status, delta = turner.outcome(turner.send(-2.8))
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert turner.heard[0] == pytest.approx(2 * math.pi - 5.6 + 0.02, abs=0.02)
    assert delta == pytest.approx(-(2 * math.pi - 5.6), abs=0.04)


def test_a_goal_that_is_reached_already_ends_with_the_next_tick(bench: Bench) -> None:
    turner = Turner(bench)
    assert turner.outcome(turner.send(0.01)) == (GoalStatus.STATUS_SUCCEEDED, 0.0)
    assert turner.heard == [float32(0.01)]


def test_while_it_turns_commands_do_nothing(bench: Bench) -> None:
    turner = Turner(bench)
    poses = bench.listen(Pose, "/turtle1/pose")
    goal = turner.send(1.0)
    bench.command(2.0)
    bench.run(0.3)
    assert {(pose.x, pose.linear_velocity) for pose in poses} == {(poses[0].x, 0.0)}
    turner.outcome(goal)
    bench.command(2.0)
    bench.run(0.3)
    assert poses[-1].linear_velocity == 2.0


def test_a_driving_turtle_stops_to_turn(bench: Bench) -> None:
    turner = Turner(bench)
    poses = bench.listen(Pose, "/turtle1/pose")
    bench.command(2.0)
    bench.run(0.3)
    assert poses[-1].linear_velocity == 2.0
    turner.outcome(turner.send(0.5))
    bench.run(0.1)
    assert (poses[-1].linear_velocity, poses[-1].angular_velocity) == (0.0, 0.0)


def test_it_is_cancelled_and_stands_still(bench: Bench) -> None:
    turner = Turner(bench)
    goal = turner.send(3.0)
    bench.run(0.5)
    assert goal.cancel_goal().goals_canceling
    status, delta = turner.outcome(goal)
    assert status == GoalStatus.STATUS_CANCELED
    assert delta == pytest.approx(-0.5, abs=0.04)
    assert bench.log()[STARTED:] == ["[INFO]: Rotation goal canceled"]
    poses = bench.listen(Pose, "/turtle1/pose")
    bench.run(0.1)
    assert {pose.angular_velocity for pose in poses} == {0.0}


def test_a_new_goal_aborts_the_one_before(bench: Bench) -> None:
    turner = Turner(bench)
    first = turner.send(3.0)
    bench.run(0.3)
    second = turner.send(-0.2)
    assert turner.outcome(first)[0] == GoalStatus.STATUS_ABORTED
    assert turner.outcome(second)[0] == GoalStatus.STATUS_SUCCEEDED
    assert bench.log()[STARTED:] == [
        "[WARN]: Rotation goal received before a previous goal finished. Aborting previous goal",
        "[INFO]: Rotation goal completed successfully",
    ]


@pytest.mark.parametrize("theta", [math.nan, math.inf, -math.inf, 3e38])
def test_a_heading_that_is_none_is_rejected(bench: Bench, theta: float) -> None:
    goal = Turner(bench).send(theta)
    assert not goal.accepted
    (line,) = bench.log()[STARTED:]
    assert line.startswith("[ERROR]: Turtle [turtle1] cannot rotate to theta=")


def test_every_turtle_has_its_own_action_and_takes_it_away(bench: Bench) -> None:
    bench.call(Spawn, "/spawn", x=2.0, y=2.0, name="bob")
    assert [name for name, _ in bench.node.get_action_names_and_types()] == [
        "/bob/rotate_absolute",
        "/turtle1/rotate_absolute",
    ]
    turner = Turner(bench, "bob")
    turner.send(3.0)
    bench.run(0.2)
    bench.call(Kill, "/kill", name="bob")
    bench.run(1.0)
    assert not turner.client.server_is_ready()
    assert bench.process.alive
    turner.client.destroy()
    assert [name for name, _ in bench.node.get_action_names_and_types()] == ["/turtle1/rotate_absolute"]


@given(st.floats(-1e6, 1e6, width=32), st.floats(-PI, PI))
def test_any_heading_is_reached_the_shorter_way(theta: float, heading: float) -> None:
    rotation = Rotation(theta, heading)
    way = abs(normalized(normalized(theta) - float32(heading)))
    ticks = 0
    while not rotation.reached and ticks < 200:
        heading = normalized(heading + rotation.step(heading) * TICK)
        ticks += 1
    assert rotation.reached
    assert ticks <= way / TICK + 2
    assert abs(rotation.remaining) < 0.021 or abs(abs(rotation.remaining) - 2 * PI) < 0.021


def test_a_turtle_that_has_turned_comes_to_rest() -> None:
    world = TurtleWorld()
    turtle = world.turtles["turtle1"]
    rotation = turtle.rotate_to(0.1)
    for _ in range(80):
        world.tick()
    assert rotation.reached and turtle.at_rest
    assert (turtle.angular, turtle.theta) == (0.0, pytest.approx(0.096))
