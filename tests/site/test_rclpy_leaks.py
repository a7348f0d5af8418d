"""What runs for hours must not grow: futures, timers, callback groups and clients keep nothing that is over."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future

from turtle_lesson.ros.runtime.world import World

Run = Callable[..., list[Any]]
Request = AddTwoInts.Request


def start() -> Node:
    """Begin as a program does: a node called n, in the running process."""
    rclpy.init()
    return rclpy.create_node("n")


def server() -> None:
    """A program that offers /add, and takes 1 s to answer."""
    rclpy.init()
    node = rclpy.create_node("server")
    node.create_service(AddTwoInts, "add", lambda request, response: (time.sleep(1), response)[1])
    rclpy.spin(node)


def test_a_future_that_is_spun_for_is_watched_once(world: World) -> None:
    node, future, kept = start(), Future(), []
    node.create_timer(0.1, lambda: kept.append(len(future._callbacks)))
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    for _ in range(5):
        executor.spin_until_future_complete(future, timeout_sec=1.0)
    assert len(kept) > 40
    assert set(kept) == {1}


def test_a_destroyed_entity_leaves_its_callback_group(world: World) -> None:
    node = start()
    before = len(node.default_callback_group.entities)
    for _ in range(100):
        node.destroy_timer(node.create_timer(1.0, lambda: None))
    assert len(node.default_callback_group.entities) == before


def test_a_callback_group_keeps_nothing_alive(world: World) -> None:
    group = MutuallyExclusiveCallbackGroup()

    class Thing:
        pass

    thing = Thing()
    group.add_entity(thing)
    assert group.has_entity(thing)
    del thing
    assert len(group.entities) == 0


def test_a_watchdog_that_is_reset_all_the_time_asks_for_one_call_only(run: Run, world: World) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        watchdog = node.create_timer(600.0, lambda: found.append("barked"))
        node.create_timer(0.01, watchdog.reset)
        rclpy.spin(node)

    assert run(program) == []
    assert len(world.sim._heap) < 10


def test_a_watchdog_barks_one_period_after_its_last_reset(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, began = start(), time.time()
        node.create_timer(0.5, lambda: found.append(round(time.time() - began, 2)))
        watchdog = next(iter(node.timers))
        resets = [watchdog.reset] * 7
        node.create_timer(0.1, lambda: resets.pop()() if resets else None)
        rclpy.spin(node)

    assert run(program, seconds=2.0) == [1.2, 1.7]


def test_a_timer_whose_period_becomes_shorter_is_called_earlier(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, began = start(), time.time()
        timer = node.create_timer(5.0, lambda: found.append(round(time.time() - began, 2)))
        time.sleep(0.1)
        timer.timer_period_ns = 200_000_000
        timer.reset()
        rclpy.spin(node)

    assert run(program, seconds=1.0) == [0.3, 0.5, 0.7, 0.9]


def test_a_request_is_forgotten_when_nobody_waits_for_its_answer_any_more(world: World) -> None:
    world.spawn(server, name="server")
    node = start()
    client = node.create_client(AddTwoInts, "add")
    client.wait_for_service()
    assert client.call(Request(), timeout_sec=0.1) is None
    client.call_async(Request()).cancel()
    client.call_async(Request()).set_result("given up")
    assert client._waiting == {}
    future = client.call_async(Request())
    rclpy.spin_until_future_complete(node, future)
    assert future.result() == AddTwoInts.Response()
    assert client._waiting == {}


def test_a_late_answer_does_not_replace_a_result_that_was_set_meanwhile(world: World) -> None:
    world.spawn(server, name="server")
    node = start()
    client = node.create_client(AddTwoInts, "add")
    client.wait_for_service()
    future = client.call_async(Request())
    future.set_result("given up")
    rclpy.spin_until_future_complete(node, Future(), timeout_sec=2.0)
    assert future.result() == "given up"
