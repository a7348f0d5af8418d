"""An action server and what its clients need, for tests of actions."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient, ActionServer
from rclpy.action.client import ClientGoalHandle
from rclpy.node import Node

Goal, Result, Feedback = Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback
SendGoal, GetResult = Fibonacci.Impl.SendGoalService, Fibonacci.Impl.GetResultService

Run = Callable[..., list[Any]]


def count_up(goal_handle: Any) -> Any:
    """Counts to the goal's order, one number a second, with feedback; ends as soon as that is wanted."""
    result = Result()
    for number in range(goal_handle.request.order):
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
            return result
        result.sequence.append(number)
        goal_handle.publish_feedback(Feedback(sequence=result.sequence))
        time.sleep(1.0)
    goal_handle.succeed()
    return result


def serving(execute: Callable[[Any], Any] = count_up, executor: Any = None, **keywords: Any) -> Any:
    """A program that offers /fibonacci."""

    def server(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("server")
        ActionServer(node, Fibonacci, "fibonacci", execute, **keywords)
        rclpy.spin(node, executor() if executor else None)

    return server


server = serving()


def start(name: str = "client") -> tuple[Node, ActionClient]:
    """Begin as a program does: a node, and a client of /fibonacci whose server is there."""
    rclpy.init()
    node = rclpy.create_node(name)
    client = ActionClient(node, Fibonacci, "fibonacci")
    assert client.wait_for_server(timeout_sec=5.0)
    return node, client


def wait(node: Node, future: Any, seconds: float | None = None) -> Any:
    """Spin until a future is done, and return its result."""
    rclpy.spin_until_future_complete(node, future, timeout_sec=seconds)
    return future.result()


def send(node: Node, client: ActionClient, order: int = 0, **keywords: Any) -> ClientGoalHandle:
    """Send a goal, and wait for its goal handle."""
    return wait(node, client.send_goal_async(Goal(order=order), **keywords))


def outcome(node: Node, goal: ClientGoalHandle) -> tuple[int, list[int]]:
    """Wait for a goal's end: its status, and the numbers of its result."""
    answer = wait(node, goal.get_result_async())
    return answer.status, list(answer.result.sequence)
