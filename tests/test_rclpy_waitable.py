"""Waitables of a program's own, and messages that are waited for by hand."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.clock import Clock, ClockType
from rclpy.executors import MultiThreadedExecutor
from rclpy.guard_condition import GuardCondition
from rclpy.node import Node
from rclpy.task import Future
from rclpy.timer import Timer
from rclpy.wait_for_message import wait_for_message
from rclpy.waitable import NumberOfEntities, Waitable
from std_msgs.msg import String

from turtle_lesson.ros.world import World

Run = Callable[..., list[Any]]


class Box(Waitable):
    """A post box: whoever puts something into it has it handled by the executor, one letter after the other."""

    def __init__(self, group: Any, found: list[Any]) -> None:
        super().__init__(group)
        self.guard = GuardCondition(None, None)
        self.letters: list[str] = []
        self.found = found

    def __enter__(self) -> None:
        """Nothing to hold."""

    def __exit__(self, *error: object) -> None:
        """Nothing to let go."""

    def put(self, letter: str) -> None:
        self.letters.append(letter)
        self.guard.trigger()

    def get_num_entities(self) -> NumberOfEntities:
        return NumberOfEntities(num_gcs=1)

    def add_to_wait_set(self, wait_set: Any) -> None:
        self.index = wait_set.add_guard_condition(self.guard.handle)

    def is_ready(self, wait_set: Any) -> bool:
        triggered = wait_set.is_ready("guard_condition", self.index)
        assert (self.guard.handle.pointer in wait_set.get_ready_entities("guard_condition")) == triggered
        return triggered or bool(self.letters)

    def take_data(self) -> str:
        return self.letters.pop(0)

    async def execute(self, taken_data: str) -> None:
        self.found.append((taken_data, round(time.monotonic(), 2)))


class Ticker(Box):
    """A waitable that waits for a timer of its own."""

    def __init__(self, group: Any, found: list[Any]) -> None:
        super().__init__(group, found)
        self.timer = Timer(None, None, 1_000_000_000, Clock(clock_type=ClockType.STEADY_TIME))

    def add_to_wait_set(self, wait_set: Any) -> None:
        self.index = wait_set.add_timer(self.timer.handle)

    def is_ready(self, wait_set: Any) -> bool:
        return wait_set.is_ready("timer", self.index)

    def take_data(self) -> str:
        with self.timer.handle:
            self.timer._take()
        return "tick"


def test_a_waitable_is_asked_when_its_guard_condition_is_triggered_and_until_it_is_empty(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        box = Box(node.default_callback_group, found)
        node.add_waitable(box)
        assert box in node.waitables
        node.create_timer(0.5, lambda: [box.put("a"), box.put("b"), node.remove_waitable(box) if found else None])
        rclpy.spin(node)

    assert run(program, seconds=1.2) == [("a", 0.5), ("b", 0.5)]


def test_a_waitable_goes_before_everything_else(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        nodes = [rclpy.create_node(name) for name in ("one", "two")]
        executor = rclpy.executors.SingleThreadedExecutor()
        for node in nodes:
            executor.add_node(node)
            node.create_timer(0.1, lambda: found.append("timer"))
        box = Box(nodes[1].default_callback_group, found)
        nodes[1].add_waitable(box)
        time.sleep(0.1)
        box.put("letter")
        for _ in range(3):
            executor.spin_once(timeout_sec=0)

    assert run(program) == [("letter", 0.1), "timer", "timer"]


def test_a_waitable_may_wait_for_a_timer(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        node.add_waitable(Ticker(ReentrantCallbackGroup(), found))
        rclpy.spin(node)

    assert run(program, seconds=3.5) == [("tick", 1.0), ("tick", 2.0), ("tick", 3.0)]


def test_one_that_is_always_ready_does_not_stop_the_time(run: Run) -> None:
    class Eager(Box):
        def is_ready(self, wait_set: Any) -> bool:
            return True

        def take_data(self) -> str:
            return ""

    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        node.add_waitable(Eager(node.default_callback_group, found))
        rclpy.spin(node)

    assert len(run(program, seconds=0.01)) == pytest.approx(0.01 / 47e-6, rel=0.02)


def test_its_futures_are_handled_by_the_executor_that_runs_it(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        box = Box(node.default_callback_group, found)
        future = Future()
        box.add_future(future)
        node.add_waitable(box)
        box.put("a")
        rclpy.spin_once(node, timeout_sec=0.1)
        found.append(future._executor is rclpy.get_global_executor())
        box.remove_future(future)

    assert run(program)[1] is True


def test_a_waitable_that_lacks_a_method_is_told_which(run: Run) -> None:
    class Bare(Waitable):
        def __enter__(self) -> None:
            """Nothing to hold."""

        def __exit__(self, *error: object) -> None:
            """Nothing to let go."""

    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        node.add_waitable(Bare(node.default_callback_group))
        with pytest.raises(NotImplementedError, match="Must be implemented by subclass") as caught:
            rclpy.spin_once(node, timeout_sec=0.1)
        found += caught.value.__notes__

    assert run(program) == ["Bare needs a method get_num_entities of its own."]


def test_what_a_wait_set_cannot_do_here_is_said(run: Run) -> None:
    class Odd(Box):
        def add_to_wait_set(self, wait_set: Any) -> None:
            for call, kind in (
                (lambda: wait_set.add_subscription(None), NotImplementedError),
                (lambda: wait_set.add_timer("x"), TypeError),
                (lambda: wait_set.get_ready_entities("subscription"), RuntimeError),
                (lambda: wait_set.nonsense, AttributeError),
            ):
                with pytest.raises(kind) as caught:
                    call()
                self.found.append(str(caught.value)[:40])
            super().add_to_wait_set(wait_set)

    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        node.add_waitable(Odd(node.default_callback_group, found))
        rclpy.spin_once(node, timeout_sec=0)
        with pytest.raises(ValueError, match="was never added to this node with add_waitable"):
            node.remove_waitable(Box(node.default_callback_group, found))

    assert run(program) == [
        "a waitable here can wait for timers and ",
        "a Timer, or its handle, is expected, got",
        "'subscription' is not a known entity of ",
        "nonsense",
    ]


def test_numbers_of_entities_are_added() -> None:
    number = NumberOfEntities(1, 2, 3) + NumberOfEntities(num_clients=4, num_services=5, num_events=6)
    assert repr(number) == "<NumberOfEntities(1, 2, 3, 4, 5, 6)>"
    number += NumberOfEntities(num_timers=1)
    assert (number.num_timers, number.num_subscriptions) == (4, 1)


# ---------------------------------------------------------------- wait_for_message


def talker(found: list[Any]) -> None:
    """Says a number every second."""
    rclpy.init(args=[])
    node = rclpy.create_node("talker")
    publisher = node.create_publisher(String, "chatter", 10)
    numbers = iter(range(100))
    node.create_timer(1.0, lambda: publisher.publish(String(data=str(next(numbers)))))
    rclpy.spin(node)


def test_the_next_message_is_waited_for(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        time.sleep(1.5)
        got, message = wait_for_message(String, node, "chatter")
        found.append((got, message.data, round(time.monotonic(), 1)))
        found.append(wait_for_message(String, node, "chatter", time_to_wait=0.5))
        found.append(wait_for_message(String, node, "nothing", 0.1, qos_profile=5))
        found.append(list(node.subscriptions))

    assert run(program, talker) == [(True, "1", 2.0), (False, None), (False, None), []]


def test_nobody_else_takes_the_message_that_is_waited_for(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")

        def wait() -> None:
            timer.cancel()
            found.append(wait_for_message(String, node, "chatter")[0])

        timer = node.create_timer(0.1, wait, callback_group=MutuallyExclusiveCallbackGroup())
        executor = MultiThreadedExecutor(3)
        executor.add_node(node)
        executor.spin()

    assert run(program, talker, seconds=3.0) == [True]


def test_a_shutdown_ends_the_waiting(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        other = Node("other")
        other.create_timer(1.0, rclpy.shutdown)

        def wait() -> None:
            timer.cancel()
            found.append(wait_for_message(String, node, "nothing"))

        timer = other.create_timer(0.1, wait, callback_group=MutuallyExclusiveCallbackGroup())
        executor = MultiThreadedExecutor(3)
        executor.add_node(other)
        executor.spin()
        time.sleep(0.1)

    assert run(program) == [(False, None)]


def test_a_cell_may_wait_for_a_message(world: World) -> None:
    world.spawn(lambda: talker([]), name="talker")
    rclpy.init(args=[])
    got, message = wait_for_message(String, rclpy.create_node("n"), "chatter")
    assert (got, message.data) == (True, "0")
