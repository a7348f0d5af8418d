"""Executors and callback groups of a program's own, the executor of events, and futures by hand."""

from __future__ import annotations

import contextlib
import gc
import time
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import (
    ConditionReachedException,
    Executor,
    ExternalShutdownException,
    MultiThreadedExecutor,
    SingleThreadedExecutor,
    TimeoutException,
    TimeoutObject,
    await_or_execute,
)
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import String
from std_srvs.srv import Trigger

from turtle_lesson.ros.runtime.world import World

Run = Callable[..., list[Any]]
Capture = pytest.CaptureFixture[str]


class Noting(Executor):
    """Notes whose callbacks it runs."""

    def __init__(self) -> None:
        super().__init__()
        self.ran: list[str] = []

    def spin_once(self, timeout_sec: float | None = None) -> None:
        try:
            handler, _, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
        except TimeoutException:
            return
        self.ran.append(node.get_name())
        handler()


def test_an_executor_of_ones_own_spins_too_and_in_a_cell_as_well(world: World) -> None:
    rclpy.init(args=[])
    executor = Noting()
    node = rclpy.create_node("n")
    executor.add_node(node)
    node.create_timer(0.5, lambda: None)
    for _ in range(3):
        executor.spin_once(timeout_sec=0.4)
    assert executor.ran == ["n"]
    assert world.now == pytest.approx(900_000_000, abs=10)
    future = executor.create_task(lambda: "done")
    executor.spin_until_future_complete(future, timeout_sec=1.0)
    assert future.result() == "done"


def test_waiting_for_a_callback_ends_with_a_timeout_or_when_a_condition_holds(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        executor = SingleThreadedExecutor()
        with pytest.raises(NotImplementedError, match="nodes is not available here"):
            executor.wait_for_ready_callbacks(nodes=[rclpy.create_node("n")])
        patience = TimeoutObject(5.0)
        patience.timeout = 0.5
        for options in ({"timeout_sec": patience}, {"condition": lambda: True}):
            with pytest.raises((TimeoutException, ConditionReachedException)) as caught:
                executor.wait_for_ready_callbacks(**options)
            found.append((caught.type.__name__, round(time.monotonic(), 2)))

    assert run(program) == [("TimeoutException", 0.5), ("ConditionReachedException", 0.5)]


def test_spin_goes_through_what_a_subclass_has_of_its_own(run: Run) -> None:
    class Careful(SingleThreadedExecutor):
        def __init__(self) -> None:
            super().__init__()
            self.story: list[str] = []

        def add_node(self, node: Node) -> bool:
            self.story.append(f"comes {node.get_name()}")
            return super().add_node(node)

        def remove_node(self, node: Node) -> None:
            self.story.append(f"goes {node.get_name()}")
            super().remove_node(node)

        def spin_once(self, timeout_sec: float | None = None) -> None:
            self.story.append("spins")
            super().spin_once(timeout_sec)

    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node, executor = rclpy.create_node("n"), Careful()
        future = Future()
        timer = node.create_timer(0.1, lambda: future.set_result("done"))
        rclpy.spin_until_future_complete(node, future, executor=executor)
        timer.cancel()
        found += [future.result(), executor.get_nodes(), *executor.story]
        executor.story.clear()
        node.create_timer(0.1, rclpy.shutdown)
        with contextlib.suppress(ExternalShutdownException):
            rclpy.spin(node, executor=executor)
        found += executor.story[:3]

    assert run(program) == ["done", [], "comes n", "goes n", "comes n", "spins", "goes n"]


def test_an_executor_that_counts_what_it_runs_and_stops_itself(run: Run) -> None:
    class Limited(MultiThreadedExecutor):
        def __init__(self, most: int) -> None:
            super().__init__(num_threads=2)
            self.left = most

        def spin(self) -> None:
            while self.left and self.context.ok():
                self.spin_once(timeout_sec=1.0)
                self.left -= 1

    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node, executor = rclpy.create_node("n"), Limited(3)
        node.create_timer(0.5, lambda: found.append(round(time.monotonic(), 1)))
        executor.add_node(node)
        executor.spin()
        time.sleep(1.0)
        found.append(executor.left)

    assert run(program) == [0.5, 1.0, 1.5, 0]


def test_what_a_callback_raises_stays_with_its_handler_until_it_is_asked_for(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node, executor = rclpy.create_node("n"), Noting()
        executor.add_node(node)

        def stumble() -> None:
            timer.cancel()
            raise ValueError("a stone")

        timer = node.create_timer(0.1, stumble)
        node.create_timer(0.2, lambda: found.append("walks on"))
        handler, entity, its_node = executor.wait_for_ready_callbacks(timeout_sec=0.5)
        handler()
        found += [repr(handler.exception()), entity is timer, its_node is node]
        executor.spin_once(timeout_sec=0.5)

    assert run(program) == ["ValueError('a stone')", True, True, "walks on"]


# ---------------------------------------------------------------- callback groups


class Counting(CallbackGroup):
    """Lets two callbacks at a time run, and none while it is closed."""

    def __init__(self) -> None:
        super().__init__()
        self.running = 0
        self.most = 0
        self.closed = False

    def can_execute(self, entity: Any) -> bool:
        return not self.closed and self.running < 2

    def beginning_execution(self, entity: Any) -> bool:
        self.running += 1
        self.most = max(self.most, self.running)
        return True

    def ending_execution(self, entity: Any) -> None:
        self.running -= 1


def test_a_group_of_ones_own_decides_who_runs(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node, group = rclpy.create_node("n"), Counting()
        for name in "abc":

            def nap(name: str = name) -> None:
                found.append((name, round(time.monotonic(), 1)))
                time.sleep(1.0)

            node.create_timer(0.5, nap, callback_group=group)
        executor = MultiThreadedExecutor(4)
        executor.add_node(node)
        node.create_timer(2.0, lambda: setattr(group, "closed", True), callback_group=ReentrantCallbackGroup())
        while time.monotonic() < 4.0:
            executor.spin_once(timeout_sec=0.5)
        assert executor.can_execute(next(iter(node.timers))) is False
        found.append(group.most)

    found = run(program)
    assert sorted(found[:4]) == [("a", 0.5), ("a", 1.5), ("b", 0.5), ("b", 1.5)]  # c starves, as in any group
    assert found[4:] == [2]


def test_a_group_may_only_be_a_little_different_from_one_of_rclpys(run: Run) -> None:
    class Noting(MutuallyExclusiveCallbackGroup):
        def __init__(self) -> None:
            super().__init__()
            self.noted: list[str] = []

        def beginning_execution(self, entity: Any) -> bool:
            self.noted.append("begin")
            return super().beginning_execution(entity)

        def ending_execution(self, entity: Any) -> None:
            self.noted.append("end")
            super().ending_execution(entity)

    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node, group = rclpy.create_node("n"), Noting()
        node.create_timer(0.1, lambda: group.noted.append("tick"), callback_group=group)
        rclpy.spin_once(node)
        found += group.noted
        assert group.has_entity(next(iter(node.timers)))

    assert run(program) == ["begin", "tick", "end"]


class Gate(CallbackGroup):
    """Lets callbacks through, one at a time, while it is open; remembers of which kind they were."""

    def __init__(self) -> None:
        super().__init__()
        self.open = True
        self.busy = False
        self.seen: list[str] = []

    def can_execute(self, entity: Any) -> bool:
        return self.open and not self.busy

    def beginning_execution(self, entity: Any) -> bool:
        self.busy = True
        self.seen.append(type(entity).__name__)
        return True

    def ending_execution(self, entity: Any) -> None:
        self.busy = False


def test_a_group_of_ones_own_is_asked_for_every_kind_of_callback(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node, group = rclpy.create_node("n"), Gate()
        node.create_timer(0.1, lambda: found.append("timer"), callback_group=group)
        node.create_subscription(String, "t", lambda message: found.append("message"), 10, callback_group=group)
        node.create_service(Trigger, "s", lambda request, response: response, callback_group=group)
        client = node.create_client(Trigger, "s", callback_group=group)
        guard = node.create_guard_condition(lambda: found.append("guard"), callback_group=group)
        node.create_publisher(String, "t", 10).publish(String())
        guard.trigger()
        future = client.call_async(Trigger.Request())
        rclpy.spin_until_future_complete(node, future)
        rclpy.spin_once(node, timeout_sec=0.2)
        found.append(sorted(set(group.seen)))

    *heard, kinds = run(program)
    assert sorted(heard) == ["guard", "message", "timer"]
    assert kinds == ["Client", "GuardCondition", "Service", "Subscription", "Timer"]


def test_a_closed_gate_holds_messages_up_and_loses_none(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node, group = rclpy.create_node("n"), Gate()
        group.open = False

        def hear(message: String) -> None:
            found.append((message.data, round(time.monotonic(), 1)))

        def unlock() -> None:
            group.open = True
            opener.cancel()

        node.create_subscription(String, "t", hear, 10, callback_group=group)
        opener = node.create_timer(1.0, unlock)
        publisher = node.create_publisher(String, "t", 10)
        for text in "abc":
            publisher.publish(String(data=text))
        while time.monotonic() < 2.0:
            rclpy.spin_once(node, timeout_sec=0.1)

    assert run(program) == [("a", 1.0), ("b", 1.0), ("c", 1.0)]


def test_a_group_is_free_again_after_a_callback_that_raised(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node, group = rclpy.create_node("n"), Gate()

        def stumble() -> None:
            raise ValueError("a stone")

        node.create_timer(0.1, stumble, callback_group=group)
        for _ in range(2):
            with pytest.raises(ValueError, match="a stone"):
                rclpy.spin_once(node)
        found.append((group.busy, group.seen))

    assert run(program) == [(False, ["Timer", "Timer"])]


def test_a_coroutine_keeps_a_group_of_ones_own_while_it_waits(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node, group = rclpy.create_node("n"), Gate()
        wake = Future()

        async def patient() -> None:
            waiting.cancel()
            found.append("begins")
            await wake
            found.append("goes on")

        waiting = node.create_timer(0.1, patient, callback_group=group)
        node.create_timer(0.2, lambda: found.append("same group"), callback_group=group)
        node.create_timer(0.7, lambda: wake.set_result(None) if not wake.done() else None)
        while time.monotonic() < 0.75:
            rclpy.spin_once(node, timeout_sec=0.05)

    assert run(program) == ["begins", "goes on", "same group"]


# ---------------------------------------------------------------- futures


def test_an_executor_makes_futures_whose_callbacks_it_calls(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        executor = SingleThreadedExecutor()
        future = executor.create_future()
        future.add_done_callback(lambda done: found.append(done.result()))
        future.set_result(5)
        assert found == []
        executor.spin_once(timeout_sec=0.0)

    assert run(program) == [5]


def test_a_callback_can_be_taken_away_before_it_is_called() -> None:
    heard: list[Any] = []
    future = Future()
    future.add_done_callback(heard.append)
    assert future.remove_done_callback(heard.append)
    assert not future.remove_done_callback(heard.append)
    future.set_result(None)
    assert heard == []


def test_an_exception_that_nobody_asks_for_is_told_at_the_end(capsys: Capture) -> None:
    for asked in (False, True):
        future = Future()
        future.set_exception(ValueError(f"asked: {asked}"))
        if asked:
            assert isinstance(future.exception(), ValueError)
            with pytest.raises(ValueError, match="asked: True"):
                future.result()
        del future
    gc.collect()
    assert capsys.readouterr().err == "The following exception was never retrieved: asked: False\n"


def test_functions_and_coroutines_are_run_alike() -> None:
    async def slow(text: str) -> str:
        return f"awaited {text}"

    def result_of(coroutine: Any) -> Any:
        with pytest.raises(StopIteration) as caught:
            coroutine.send(None)
        return caught.value.value

    assert result_of(await_or_execute(slow, "x")) == "awaited x"
    assert result_of(await_or_execute(str.upper, "x")) == "X"


# ---------------------------------------------------------------- waiting for nodes


def test_a_node_that_comes_is_waited_for(run: Run) -> None:
    def late(found: list[Any]) -> None:
        rclpy.init(args=[])
        time.sleep(1.05)
        rclpy.spin(Node("late", namespace="robots"))

    def program(found: list[Any]) -> None:
        rclpy.init(args=[])
        node = rclpy.create_node("n")
        found.append((node.wait_for_node("/robots/late", 0.5), round(time.monotonic(), 1)))
        found.append((node.wait_for_node("robots/late", -1), round(time.monotonic(), 1)))

    assert run(program, late) == [(False, 0.5), (True, 1.1)]


def test_a_count_goes_by_the_name_as_it_is_given_and_not_as_it_is_remapped(world: World) -> None:
    rclpy.init(args=["prog", "--ros-args", "-r", "a:=b"])
    node = rclpy.create_node("n")
    node.create_publisher(String, "a", 10)
    assert (node.count_publishers("a"), node.count_publishers("b"), node.count_subscribers("/b")) == (0, 1, 0)
