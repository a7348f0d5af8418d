"""The checks of page 08: met by the answers that the page shows, missed by what a learner tries first."""

from __future__ import annotations

import time
from typing import Any

import pytest
from test_lab_checks import program, row

from turtle_lesson import Lesson, start

# isort: split
# Importing turtle_lesson made these importable.
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from std_msgs.msg import Bool, Int32
from std_srvs.srv import Trigger


def bake(lesson: Lesson, *, grouped: bool, seconds: float = 0.4) -> None:
    def main() -> None:
        rclpy.init()
        node = rclpy.create_node("baker")
        bell, oven = node.create_publisher(Int32, "/bell", 10), node.create_publisher(Bool, "/oven", 10)

        def on_bake() -> None:
            oven.publish(Bool(data=True))
            time.sleep(seconds)
            oven.publish(Bool(data=False))

        group = MutuallyExclusiveCallbackGroup() if grouped else None
        node.create_timer(0.1, lambda: bell.publish(Int32()))
        node.create_timer(1.0, on_bake, callback_group=group)
        executor = MultiThreadedExecutor()
        executor.add_node(node)
        executor.spin()

    lesson._world.spawn(main, name="baker")
    lesson.run(0.2)


@pytest.mark.parametrize("grouped", [True, False])
def test_steady(grouped: bool) -> None:
    lesson = start(simulator=False)
    bake(lesson, grouped=grouped)
    result = lesson.check("steady")
    assert result.passed == grouped
    assert row(result, "the oven is on").seen == "on for 0.40 s, every 1.00 s"


def test_steady_is_not_met_by_a_baker_who_does_not_bake() -> None:
    lesson = start(simulator=False)
    bake(lesson, grouped=False, seconds=0.0)
    result = lesson.check("steady")
    assert row(result, "/bell: a message every 100 ms").good
    assert row(result, "the oven is on").seen == "on for 0.00 s, every 1.00 s"


def concierge(answer: str) -> Any:
    from robot_controller.srv import NavigateTo

    node = rclpy.create_node("concierge")
    group = MutuallyExclusiveCallbackGroup() if answer != "in one group" else None
    driver = node.create_client(NavigateTo, "/navigate_to", callback_group=group)

    async def on_go_home(request: Any, response: Any) -> Any:
        if answer == "lies":
            response.success = True
            return response
        done = await driver.call_async(NavigateTo.Request(x=5.5, y=5.5))
        response.success = done.success
        return response

    node.create_service(Trigger, "/go_home", on_go_home)
    return node


@pytest.mark.parametrize("answer", ["waits", "lies"])
def test_go_home(answer: str) -> None:
    lesson = start()
    lesson.launch("robot_controller", "start_system.launch.py", goal_timeout=20.0)

    def node() -> Any:
        return concierge(answer)

    program(lesson, node)
    result = lesson.check("go_home")
    assert result.passed == (answer == "waits")
    assert row(result, "answered with success").good
    assert row(result, "in the middle").good == (answer == "waits")


def test_go_home_without_a_navigator_says_what_is_missing() -> None:
    lesson = start()

    def node() -> Any:
        return concierge("waits")

    program(lesson, node)
    result = lesson.check("go_home")
    assert "no node offers the service /navigate_to" in row(result, "answered with success").seen
