"""Many turtles, many subscriptions: what one of them costs does not grow with their number. Steps are counted, not time."""

import sys
from types import FrameType
from typing import Any

import pytest

from turtle_lesson.ros.runtime.world import open_world


def steps(function: Any, *arguments: Any) -> int:
    """How many of Python's instructions a call carries out."""
    count = 0

    def trace(frame: FrameType, event: str, _: object) -> Any:
        nonlocal count
        frame.f_trace_opcodes = True
        count += event == "opcode"
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        function(*arguments)
    finally:
        sys.settrace(before)
    return count


@pytest.fixture
def rclpy() -> Any:
    """The rclpy of a world of its own."""
    open_world()
    import rclpy

    rclpy.init()
    steps(lambda: None)  # in Python 3.12.1 the first call of all is not counted
    return rclpy


def test_the_four_hundredth_subscription_of_a_topic_costs_what_an_early_one_does(rclpy: Any) -> None:
    from std_msgs.msg import String

    node = rclpy.create_node("many")
    publisher = node.create_publisher(String, "news", 10)
    costs = [steps(node.create_subscription, String, "news", print, 10) for _ in range(400)]
    assert publisher.get_subscription_count() == 400
    assert 0 < costs[-1] <= 1.1 * costs[20]


def test_a_tick_costs_each_of_many_turtles_the_same(rclpy: Any) -> None:
    from turtlesim.srv import Spawn

    from turtle_lesson.turtlesim.node import TurtlesimNode

    node = TurtlesimNode()

    def cost_of_each(count: int) -> float:
        for _ in range(count - len(node._world.turtles)):
            node._on_spawn(Spawn.Request(x=1.0, y=1.0), Spawn.Response())
        node._on_tick()
        return steps(node._on_tick) / count

    few, many = cost_of_each(40), cost_of_each(400)  # of the first few the trace notes each message
    assert 0 < many <= 1.1 * few


def test_three_hundred_processes_at_once_need_no_deeper_stack_than_one(rclpy: Any) -> None:
    world = open_world()
    heard = []

    def main(number: int) -> None:
        import rclpy
        from std_msgs.msg import String

        rclpy.init()
        node = rclpy.create_node(f"node{number}")
        publisher = node.create_publisher(String, f"news{(number + 1) % 300}", 10)
        node.create_subscription(String, f"news{number}", heard.append, 10)
        node.create_timer(0.1, lambda: publisher.publish(String(data=str(number))))
        rclpy.spin(node)

    for number in range(300):
        world.spawn(lambda number=number: main(number), name=f"node{number}")  # type: ignore[misc]
    world.sim.run_until(150_000_000)
    assert sorted(int(message.data) for message in heard) == list(range(300))
