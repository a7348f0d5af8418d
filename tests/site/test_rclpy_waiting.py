"""Waiting that looks hopeless and is not: somebody spins again, or completes the future. None of it is refused."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from adding_service import Request, Run, add, server
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future

from turtle_lesson.ros.runtime.world import World
from turtle_lesson.ros.sim.errors import NeverWakes


def lazy_server(found: list[Any]) -> None:
    """A program that offers /add, and takes 5 s to answer."""
    rclpy.init()
    node = rclpy.create_node("server")
    node.create_service(AddTwoInts, "add", lambda request, response: (time.sleep(5), response)[1])
    rclpy.spin(node)


def start() -> Node:
    """Begin as a program does: a node called n, in the running process."""
    rclpy.init()
    return rclpy.create_node("n")


def clock() -> Callable[[], float]:
    """A stop watch, in seconds with two decimals."""
    began = time.time()
    return lambda: round(time.time() - began, 2)


def many_threads(*nodes: Node, threads: int = 4) -> MultiThreadedExecutor:
    """An executor of several threads that runs these nodes."""
    executor = MultiThreadedExecutor(threads)
    for node in nodes:
        executor.add_node(node)
    return executor


def once(node: Node, seconds: float, callback: Callable[[], object]) -> None:
    """Have a callback of a group of its own called once."""

    def tick() -> None:
        timer.cancel()
        callback()

    timer = node.create_timer(seconds, tick, callback_group=MutuallyExclusiveCallbackGroup())


# ---------------------------------------------------------------- the main program spins now and then


def test_a_thread_may_call_while_the_main_loop_does_something_else(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now = start(), clock()
        client = node.create_client(AddTwoInts, "add", callback_group=MutuallyExclusiveCallbackGroup())
        once(node, 0.5, lambda: found.append(client.call(Request(a=1, b=2)).sum))
        executor = many_threads(node)
        while now() < 1.0:
            executor.spin_once(timeout_sec=0.1)
            time.sleep(0.01)

    assert run(server, program) == [3]


def test_a_thread_may_call_while_nobody_spins_if_somebody_spins_later(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now = start(), clock()
        client = node.create_client(AddTwoInts, "add", callback_group=MutuallyExclusiveCallbackGroup())
        once(node, 0.1, lambda: (time.sleep(0.5), found.append((client.call(Request(a=1, b=2)).sum, now()))))
        executor = many_threads(node)
        executor.spin_until_future_complete(Future(), timeout_sec=0.3)
        time.sleep(0.5)
        executor.spin_until_future_complete(Future(), timeout_sec=1.0)

    assert run(server, program) == [(3, 0.8)]


def test_a_thread_may_call_a_service_of_a_node_that_is_spun_in_turns_with_its_own(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, other, now = start(), rclpy.create_node("other"), clock()
        other.create_service(AddTwoInts, "add", add)
        client = node.create_client(AddTwoInts, "add", callback_group=MutuallyExclusiveCallbackGroup())
        once(node, 0.1, lambda: found.append(client.call(Request(a=1, b=2)).sum))
        executor = many_threads(node)
        while now() < 1.0:
            executor.spin_once(timeout_sec=0.1)
            rclpy.spin_once(other, timeout_sec=0.01)

    assert run(program) == [3]


def test_a_thread_may_sleep_at_a_rate_while_the_main_loop_does_something_else(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now = start(), clock()

        def walk() -> None:
            time.sleep(0.005)  # the main loop does not spin just then
            rate = node.create_rate(10)
            for _ in range(3):
                rate.sleep()
            found.append("walked")

        once(node, 0.1, walk)
        executor = many_threads(node)
        while now() < 1.0:
            executor.spin_once(timeout_sec=0.1)
            time.sleep(0.05)

    assert run(program) == ["walked"]


def test_an_executor_that_spins_to_the_end_spins_no_other_nodes(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, other = start(), rclpy.create_node("other")
        other.create_service(AddTwoInts, "add", add)
        client = node.create_client(AddTwoInts, "add", callback_group=MutuallyExclusiveCallbackGroup())

        def call() -> None:
            with pytest.raises(NeverWakes) as caught:
                client.call(Request())
            found.append("cannot be called while this callback waits" in str(caught.value))

        once(node, 0.1, call)
        many_threads(node).spin()

    assert run(program) == [True]


# ---------------------------------------------------------------- somebody else completes the future


def test_a_coroutine_may_wait_in_the_clients_group_if_a_time_limit_ends_that(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now = start(), clock()
        client = node.create_client(AddTwoInts, "add")

        async def ask() -> None:
            timer.cancel()
            future = client.call_async(Request())
            once(node, 1.0, lambda: future.set_result("too late"))
            found.append((await future, now()))

        timer = node.create_timer(0.1, ask)
        rclpy.spin(node)

    assert run(lazy_server, program) == [("too late", 1.1)]


def test_a_coroutine_may_wait_in_the_clients_group_if_the_main_loop_ends_that(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now = start(), clock()
        client = node.create_client(AddTwoInts, "add")
        asked: list[Future] = []

        async def ask() -> None:
            timer.cancel()
            asked.append(client.call_async(Request()))
            found.append(await asked[0])

        timer = node.create_timer(0.1, ask)
        while now() < 2.0:
            rclpy.spin_once(node, timeout_sec=0.1)
            if now() > 1.0 and not asked[0].done():
                asked[0].set_result("too late")

    assert run(lazy_server, program) == ["too late"]


def test_a_callback_may_spin_in_the_clients_group_if_a_time_limit_ends_that(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now = start(), clock()
        client = node.create_client(AddTwoInts, "add")
        executor = SingleThreadedExecutor()
        executor.add_node(node)

        def ask() -> None:
            timer.cancel()
            future = client.call_async(Request())
            once(node, 1.0, lambda: future.set_result("too late"))
            executor.spin_until_future_complete(future)
            found.append((future.result(), now()))

        timer = node.create_timer(0.1, ask)
        executor.spin()

    assert run(lazy_server, program) == [("too late", 1.1)]


def test_spinning_for_a_future_ends_with_it_although_all_threads_are_busy(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now, future = start(), clock(), Future()
        once(node, 0.1, lambda: (time.sleep(0.5), future.set_result(1), time.sleep(5)))
        once(node, 0.1, lambda: time.sleep(5))
        many_threads(node, threads=2).spin_until_future_complete(future)
        found.append(now())

    assert run(program) == [0.6]


# ---------------------------------------------------------------- from a plain cell


def test_a_cell_that_spins_several_threads_once_sees_what_the_callback_did(world: World) -> None:
    node, ticks = start(), []
    node.create_timer(1.0, lambda: ticks.append(1))
    executor = many_threads(node)
    executor.spin_once(timeout_sec=2.0)
    assert len(ticks) == 1
    rclpy.spin_once(node, executor=executor, timeout_sec=2.0)
    assert len(ticks) == 2


def test_a_cell_that_spins_several_threads_once_hears_of_an_error_in_the_callback(world: World) -> None:
    node = start()
    node.create_timer(1.0, lambda: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        many_threads(node).spin_once(timeout_sec=2.0)


def test_a_cell_that_calls_spins_its_node_for_no_longer_than_that(world: World) -> None:
    world.spawn(lambda: server([]), name="server")
    node, ticks = start(), []
    client = node.create_client(AddTwoInts, "add")
    client.wait_for_service()
    assert client.call(Request(a=1, b=2)).sum == 3
    assert rclpy.get_global_executor().get_nodes() == []
    node.create_timer(0.1, lambda: ticks.append(1))
    rclpy.spin_until_future_complete(rclpy.create_node("other"), Future(), timeout_sec=1.0)
    assert ticks == []


def test_a_cell_that_calls_leaves_its_node_with_the_executor_that_has_it(world: World) -> None:
    world.spawn(lambda: server([]), name="server")
    node = start()
    client, executor = node.create_client(AddTwoInts, "add"), SingleThreadedExecutor()
    executor.add_node(node)
    client.wait_for_service()
    client.call(Request())
    assert node.executor is executor


def test_a_program_called_notebook_is_not_taken_for_the_notebook(world: World) -> None:
    told: list[str] = []

    def program() -> None:
        node = start()
        node.create_service(AddTwoInts, "add", add)
        try:
            node.create_client(AddTwoInts, "add").call(Request())
        except NeverWakes as error:
            told.append(str(error))

    world.spawn(program, name="notebook")
    world.sim.run_until(1_000_000_000)
    assert "no executor spins <Node /n> meanwhile" in told[0]
