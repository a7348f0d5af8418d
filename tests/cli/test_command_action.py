"""`ros2 action`: as recorded beside turtlesim, as its source has it, and with words of our own where it would hang."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import command_system as system
import pytest
import rclpy
from command_cases import cases, shape, type_in
from example_interfaces.action import Fibonacci
from fibonacci_action import Result, count_up, serving
from rclpy.action import ActionClient, CancelResponse

from turtle_lesson.ros.cli.completion import complete
from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.runtime.world import World, current_world, open_world
from turtle_lesson.turtlesim.node import main as turtlesim

SEND = "ros2 action send_goal /fibonacci example_interfaces/action/Fibonacci '{order: 2}'"


@pytest.fixture
def turtle() -> Iterator[World]:
    """A world with turtlesim in it."""
    world = open_world()
    world.spawn(turtlesim, name="turtlesim_node")
    world.sim.run_until(world.now + 100_000_000)
    yield world
    world.close()


def offer(world: World, execute: Any = count_up, **keywords: Any) -> None:
    """Have /fibonacci offered."""
    world.spawn(lambda: serving(execute, **keywords)([]), name="server")


def without_ids(lines: list[str]) -> list[str]:
    return shape([re.sub(r"ID: [0-9a-f]{32}", "ID: …", line) for line in lines], figures=True)


def ends(lines: list[str]) -> list[str]:
    """Lines without the feedback between the first and the last one."""
    marks = [number for number, line in enumerate(lines) if line == "Feedback:"]
    return lines if len(marks) < 3 else lines[: marks[1]] + lines[marks[-1] :]


def test_beside_turtlesim_as_recorded(turtle: World) -> None:
    for case in cases("action.txt"):
        answer = type_in(turtle, case.command)
        assert answer.stderr.splitlines() == case.stderr, case.command
        assert without_ids(ends(answer.stdout.splitlines())) == without_ids(case.stdout), case.command
        assert answer.code == case.code, case.command


def test_a_goal_prints_its_feedback_as_it_comes(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    offer(world)
    answer = type_in(world, f"{SEND} -f")
    assert answer.stdout.split("\n\n", 2)[2] == (
        "Feedback:\n    sequence:\n- 0\n\nFeedback:\n    sequence:\n- 0\n- 1\n\nResult:\n    sequence:\n- 0\n- 1\n\n"
        "Goal finished with status: SUCCEEDED\n"
    )
    assert (answer.stderr, answer.code) == ("", 0)
    assert answer.seconds == pytest.approx(2.1, abs=0.01)  # it looks around first


@pytest.mark.parametrize(("end", "status"), [("abort", "ABORTED"), ("succeed", "SUCCEEDED")])
def test_the_status_is_told_however_a_goal_ends(world: World, end: str, status: str) -> None:
    offer(world, lambda goal_handle: getattr(goal_handle, end)() or Result())
    answer = type_in(world, SEND)
    assert answer.stdout.endswith(f"Result:\n    sequence: []\n\nGoal finished with status: {status}\n")
    assert answer.code == 0


def test_a_goal_that_is_cancelled_by_somebody_else(turtle: World) -> None:
    def other() -> None:
        rclpy.init()
        node = rclpy.create_node("other")
        from action_msgs.srv import CancelGoal

        client = node.create_client(CancelGoal, "/turtle1/rotate_absolute/_action/cancel_goal")
        node.create_timer(1.0, lambda: client.call_async(CancelGoal.Request()))
        rclpy.spin(node)

    turtle.spawn(other, name="other")
    answer = type_in(
        turtle, "ros2 action send_goal turtle1/rotate_absolute turtlesim/action/RotateAbsolute '{theta: 3}'"
    )
    assert answer.stdout.endswith("Goal finished with status: CANCELED\n")


def test_a_server_that_cancels_nothing(world: World) -> None:
    offer(world, executor=rclpy.executors.MultiThreadedExecutor)
    answer = type_in(world, f"{SEND} --for 1")
    assert answer.stdout.endswith("\n\nCanceling goal...\n")
    assert answer.stderr == "Failed to cancel goal\nThe server continues: its cancel_callback refused the request.\n"
    assert answer.code == 1


def test_a_server_whose_thread_is_busy(world: World) -> None:
    offer(world)
    answer = type_in(world, f"{SEND.replace(': 2', ': 20')} --for 1")
    assert answer.stderr == "No answer to the cancel request: is the server's node busy with something else?\n"
    answer = type_in(world, f"{SEND} --for 2")
    assert answer.stderr == ("No answer to the goal: is the server's node busy with something else?\n")
    assert answer.code == 1


def test_a_server_that_goes_away(world: World) -> None:
    def execute(goal_handle: Any) -> Any:
        raise SystemExit(0)

    offer(world, execute)
    answer = type_in(world, SEND)
    assert answer.stderr == "/fibonacci went away before it answered: did its node end, or did an error stop it?\n"
    assert answer.code == 1


def test_ctrl_c_asks_to_cancel_the_goal(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    offer(
        world,
        executor=rclpy.executors.MultiThreadedExecutor,
        cancel_callback=lambda goal_handle: print("wants to cancel") or CancelResponse.ACCEPT,
    )
    run_line(world, f"{SEND.replace(': 2', ': 20')} &")
    world.sim.run_until(world.now + 3_000_000_000)
    run_line(world, "kill -INT %1")
    world.sim.run_until(world.now + 2_000_000_000)
    assert "Canceling goal...\nwants to cancel\n" in capsys.readouterr().out
    assert world.processes[-1].exit_code == 2


def test_clients_and_servers_of_an_action(world: World) -> None:
    def client() -> None:
        rclpy.init()
        node = rclpy.create_node("client", namespace="/team")
        ActionClient(node, Fibonacci, "/fibonacci")
        rclpy.spin(node)

    offer(world)
    system.start(world, client)
    assert type_in(world, "ros2 action info -t /fibonacci").stdout.splitlines() == [
        "Action: /fibonacci",
        "Action clients: 1",
        "    /team/client [example_interfaces/action/Fibonacci]",
        "Action servers: 1",
        "    /server [example_interfaces/action/Fibonacci]",
    ]
    assert "  Action Clients:\n    /fibonacci: example_int" in type_in(world, "ros2 node info /team/client").stdout
    assert type_in(world, "ros2 action list").stdout == "/fibonacci\n"


def test_where_there_are_no_actions(world: World) -> None:
    assert [type_in(world, f"ros2 action list {option}").stdout for option in ("", "-t", "-c")] == ["", "", "0\n"]


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("ros2 act", ["action"]),
        ("ros2 action ", ["--help", "find", "info", "list", "send_goal", "type"]),
        ("ros2 action info ", ["/turtle1/rotate_absolute"]),
        ("ros2 action type /tu", ["/turtle1/rotate_absolute"]),
        ("ros2 action find turtles", ["turtlesim/action/RotateAbsolute"]),
        ("ros2 action send_goal ", ["/turtle1/rotate_absolute"]),
        ("ros2 action send_goal /turtle1/rotate_absolute ", ["turtlesim/action/RotateAbsolute"]),
        ("ros2 action send_goal /nope example_i", ["example_interfaces/action/Fibonacci"]),
        (
            "ros2 action send_goal /turtle1/rotate_absolute turtlesim/action/RotateAbsolute ",
            ['"{theta: 0.0}"'],
        ),
        ("ros2 action send_goal -", ["--feedback", "--for", "--help", "-f", "-h"]),
        ("ros2 action list --", ["--count-actions", "--help", "--show-types"]),
    ],
)
def test_tab(turtle: World, line: str, offered: list[str]) -> None:
    assert complete(current_world(), line) == offered
