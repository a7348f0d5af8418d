"""Executors and timers, against recordings of a real rclpy. Its jitter of a millisecond or so is rounded away."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import (
    Executor,
    ExternalShutdownException,
    MultiThreadedExecutor,
    ShutdownException,
    SingleThreadedExecutor,
    TimeoutException,
)
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import String

from turtle_lesson.ros.runtime.world import World
from turtle_lesson.ros.sim.errors import NeverWakes

Run = Callable[..., list[Any]]


def start() -> Node:
    """Begin as a program does: a node called n, in the running process."""
    rclpy.init()
    return rclpy.create_node("n")


def clock() -> Callable[[], float]:
    """A stop watch, in seconds with three decimals."""
    began = time.time()
    return lambda: round(time.time() - began, 3)


# ---------------------------------------------------------------- timers that fall behind


def starts_of(run: Run, naps: dict[int, float] | float, seconds: float) -> list[float]:
    """When the callback of a 0.1 s timer begins, if it sleeps: at some of its calls, or at all."""

    def program(found: list[float]) -> None:
        node, now = start(), clock()

        def tick() -> None:
            found.append(now())
            time.sleep(naps.get(len(found), 0.0) if isinstance(naps, dict) else naps)

        node.create_timer(0.1, tick)
        rclpy.spin(node)

    return run(program, seconds=seconds)


def test_after_one_long_callback_a_timer_catches_up_once_and_keeps_its_phase(run: Run) -> None:
    # recorded: 0.101 0.2 0.3 0.652 0.701 0.8 0.901 1.001 1.1 1.2 1.3 1.4 1.5
    expected = [0.1, 0.2, 0.3, 0.65, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5]
    assert starts_of(run, {3: 0.35}, seconds=1.55) == expected


def test_a_callback_longer_than_three_periods_is_called_again_at_once(run: Run) -> None:
    # recorded: 0.1 0.451 0.802 1.152 1.503 1.854 2.205
    assert starts_of(run, 0.35, seconds=2.3) == [0.1, 0.45, 0.8, 1.15, 1.5, 1.85, 2.2]


def test_a_callback_a_little_too_long_is_called_as_often_as_it_can_be(run: Run) -> None:
    # recorded: 0.1 0.231 0.362 0.493 0.624 0.754 0.885 1.016 1.147 1.277 1.408
    expected = [0.1, 0.23, 0.36, 0.49, 0.62, 0.75, 0.88, 1.01, 1.14, 1.27, 1.4]
    assert starts_of(run, 0.13, seconds=1.5) == expected


def test_cancel_and_reset(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        timer = node.create_timer(0.2, lambda: None)
        found.append((timer.time_until_next_call(), timer.is_ready(), timer.is_canceled()))
        timer.cancel()
        found.append((timer.time_until_next_call(), timer.is_ready(), timer.is_canceled()))
        time.sleep(0.5)
        timer.reset()
        found.append((timer.time_until_next_call(), timer.is_ready(), timer.is_canceled()))
        time.sleep(0.2)
        found.append(timer.is_ready())

    assert run(program) == [(200_000_000, False, False), (None, False, True), (200_000_000, False, False), True]


def test_a_cancelled_timer_rests_and_ticks_again_one_period_after_its_reset(run: Run) -> None:
    def program(found: list[float]) -> None:
        node, now = start(), clock()
        ticking = node.create_timer(0.1, lambda: found.append(now()))
        plan = iter([ticking.cancel, lambda: None, ticking.reset])
        node.create_timer(0.25, lambda: next(plan, lambda: None)())
        rclpy.spin(node)

    assert run(program, seconds=1.1) == [0.1, 0.2, 0.85, 0.95, 1.05]


def test_a_timer_that_does_not_start_by_itself_waits_for_its_reset(run: Run) -> None:
    def program(found: list[float]) -> None:
        node, now = start(), clock()
        late = node.create_timer(0.1, lambda: found.append(now()), autostart=False)
        once = node.create_timer(0.5, lambda: (once.cancel(), late.reset()))
        rclpy.spin(node)

    assert run(program, seconds=0.75) == [0.6, 0.7]


def test_a_timer_of_period_zero_is_called_as_often_as_a_real_one_manages(run: Run) -> None:
    def program(found: list[int]) -> None:
        node = start()
        node.create_timer(0, lambda: found.append(1))
        rclpy.spin(node)

    assert len(run(program, seconds=0.1)) == pytest.approx(2141, abs=20)  # recorded: 21,410 a second


# ---------------------------------------------------------------- the order within one executor


def test_ready_callbacks_run_in_order_and_what_they_cause_waits_for_the_next_cycle(run: Run) -> None:
    def program(found: list[str]) -> None:
        node = start()
        publisher = node.create_publisher(String, "topic", 10)

        def tick(letter: str) -> None:
            found.append(letter)
            publisher.publish(String())

        node.create_timer(0.1, lambda: tick("A"))
        node.create_timer(0.1, lambda: tick("B"))
        node.create_subscription(String, "topic", lambda _: found.append("c"), 10)
        publisher.publish(String())
        rclpy.spin(node)

    assert "".join(run(program, seconds=0.65)) == "cABccABccABccABccABccABcc"


def test_each_cycle_takes_one_message_of_each_subscription(run: Run) -> None:
    def program(found: list[str]) -> None:
        node = start()
        publisher = node.create_publisher(String, "topic", 10)
        node.create_subscription(String, "topic", lambda message: found.append(f"s{message.data}"), 10)
        node.create_subscription(String, "topic", lambda message: found.append(f"S{message.data}"), 10)
        timer = node.create_timer(0.1, lambda: (found.append("T"), timer.cancel()))
        for number in range(4):
            publisher.publish(String(data=str(number)))
        time.sleep(0.2)
        while len(found) < 9:
            rclpy.spin_once(node)

    assert run(program) == ["T", "s0", "S0", "s1", "S1", "s2", "S2", "s3", "S3"]


def everything_ready_at_once(found: list[str], spin: Callable[[Node], object]) -> None:
    node = start()
    a, b = node.create_publisher(String, "a", 10), node.create_publisher(String, "b", 10)

    def serve(request: Any, response: Any) -> Any:
        found.append("service")
        return response

    node.create_subscription(String, "b", lambda message: found.append(f"sub_{message.data}"), 10)
    node.create_service(AddTwoInts, "add", serve)
    node.create_subscription(String, "a", lambda message: found.append(f"sub_{message.data}"), 10)
    guard = node.create_guard_condition(lambda: found.append("guard"))
    client = node.create_client(AddTwoInts, "add")
    first = node.create_timer(0.2, lambda: (found.append("timer1"), first.cancel()))
    second = node.create_timer(0.1, lambda: (found.append("timer2"), second.cancel()))
    a.publish(String(data="a1"))
    b.publish(String(data="b1"))
    client.call_async(AddTwoInts.Request()).add_done_callback(lambda _: found.append("client_done"))
    guard.trigger()
    a.publish(String(data="a2"))
    time.sleep(0.3)
    spin(node)


RECORDED_ORDER = ["timer1", "timer2", "sub_b1", "sub_a1", "guard", "service", "sub_a2", "client_done"]


def test_timers_go_before_subscriptions_guards_and_services_each_as_created(run: Run) -> None:
    assert run(lambda found: everything_ready_at_once(found, rclpy.spin)) == RECORDED_ORDER


def test_spinning_once_at_a_time_gives_the_same_order(run: Run) -> None:
    def one_by_one(node: Node) -> None:
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        for _ in range(10):
            executor.spin_once(timeout_sec=0.05)

    assert run(lambda found: everything_ready_at_once(found, one_by_one)) == RECORDED_ORDER


def test_the_nodes_of_an_executor_take_turns_in_the_order_in_which_they_were_added(run: Run) -> None:
    def program(found: list[str]) -> None:
        node, other = start(), rclpy.create_node("other")
        node.create_timer(0.1, lambda: found.append("node"))
        other.create_timer(0.1, lambda: found.append("other"))
        executor = SingleThreadedExecutor()
        executor.add_node(other)
        executor.add_node(node)
        assert executor.get_nodes() == [other, node]
        executor.spin()

    assert run(program, seconds=0.25) == ["other", "node"] * 2


def test_a_node_hears_itself_but_only_when_it_is_spun(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, heard = start(), []
        publisher = node.create_publisher(String, "topic", 10)
        node.create_subscription(String, "topic", lambda message: heard.append(message.data), 10)
        timer = node.create_timer(0.1, lambda: tick())

        def tick() -> None:
            publisher.publish(String(data="3"))
            found.append(("right after publish", list(heard)))
            timer.cancel()

        for _ in range(4):
            rclpy.spin_once(node, timeout_sec=0.1)
        found.append(("after spin", heard))

    assert run(program) == [("right after publish", []), ("after spin", ["3"])]


def test_a_done_callback_that_fails_is_told_of_and_the_others_are_called(world: World) -> None:
    called: list[str] = []
    future = Future()
    future.add_done_callback(lambda _: 1 / 0)
    future.add_done_callback(lambda _: called.append("second"))
    with pytest.warns(UserWarning, match=r"Unhandled exception in done callback: ZeroDivisionError.*<lambda>") as told:
        future.set_result(1)
    assert told[0].filename == __file__
    assert called == ["second"]


# ---------------------------------------------------------------- who is held up


def test_a_sleeping_callback_holds_up_its_own_process_and_no_other(run: Run) -> None:
    def sleepy(found: list[Any]) -> None:
        node, now = start(), clock()
        node.create_timer(0.1, lambda: found.append(("sleepy heartbeat", now())))
        nap = node.create_timer(0.25, lambda: (nap.cancel(), time.sleep(1.0)))
        rclpy.spin(node)

    def awake(found: list[Any]) -> None:
        node, now = start(), clock()
        node.create_timer(0.4, lambda: found.append(("awake", now())))
        rclpy.spin(node)

    assert run(sleepy, awake, seconds=1.45) == [
        ("sleepy heartbeat", 0.1),
        ("sleepy heartbeat", 0.2),
        ("awake", 0.4),
        ("awake", 0.8),
        ("awake", 1.2),
        ("sleepy heartbeat", 1.25),
        ("sleepy heartbeat", 1.3),
        ("sleepy heartbeat", 1.4),
    ]


# ---------------------------------------------------------------- exceptions


def what_three_spins_raise(run: Run, prepare: Callable[[Node, Callable[..., Any]], object], kind: str) -> list[str]:
    def boom(*arguments: Any) -> None:
        raise ValueError(f"boom {kind}")

    def program(found: list[str]) -> None:
        node = start()
        kept = prepare(node, boom)
        for _ in range(3):
            try:
                rclpy.spin_once(node, timeout_sec=0.2)
                found.append("no exception")
            except ValueError as error:
                found.append(f"ValueError: {error}")
        del kept

    return run(program)


def test_an_exception_in_a_timer_comes_out_of_spin_each_time(run: Run) -> None:
    def prepare(node: Node, boom: Callable[..., Any]) -> Any:
        return node.create_timer(0.1, boom)

    assert what_three_spins_raise(run, prepare, "timer") == ["ValueError: boom timer"] * 3


def test_a_message_or_request_that_raised_is_gone(run: Run) -> None:
    def subscribe(node: Node, boom: Callable[..., Any]) -> Any:
        node.create_subscription(String, "topic", boom, 10)
        node.create_publisher(String, "topic", 10).publish(String())

    def serve(node: Node, boom: Callable[..., Any]) -> Any:
        node.create_service(AddTwoInts, "add", boom)
        return node.create_client(AddTwoInts, "add").call_async(AddTwoInts.Request())

    for prepare, kind in ((subscribe, "subscription"), (serve, "service")):
        expected = [f"ValueError: boom {kind}", "no exception", "no exception"]
        assert what_three_spins_raise(run, prepare, kind) == expected


def test_an_exception_in_a_worker_thread_comes_out_of_spin_too(run: Run) -> None:
    def program(found: list[str]) -> None:
        node = start()
        node.create_timer(0.1, lambda: 1 / 0)
        executor = MultiThreadedExecutor(2)
        executor.add_node(node)
        with pytest.raises(ZeroDivisionError):
            executor.spin()
        found.append("spin ended")

    assert run(program) == ["spin ended"]


@pytest.mark.parametrize(
    ("prepare", "text", "note"),
    [
        (
            lambda node: node.create_timer(0.1, lambda message: None),
            "missing 1 required positional argument: 'message'",
            "The callback of <Timer, every 0.1 s> is called with ().",
        ),
        (
            lambda node: (
                node.create_subscription(String, "t", lambda: None, 10),
                node.create_publisher(String, "t", 10).publish(String()),
            ),
            "takes 0 positional arguments but 1 was given",
            "The callback of <Subscription of t> is called with (message).",
        ),
        (
            lambda node: node.create_timer(0.1, None),
            "'NoneType' object is not callable",
            "The callback of <Timer, every 0.1 s> is None. Hand over the function itself, as in self.tick; with "
            "brackets, as in self.tick(), it is called immediately, and its result is handed over.",
        ),
    ],
)
def test_a_callback_that_cannot_be_called_is_explained(
    run: Run, prepare: Callable[[Node], object], text: str, note: str
) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        prepare(node)
        with pytest.raises(TypeError, match=text) as caught:
            rclpy.spin(node)
        found += caught.value.__notes__

    assert run(program) == [note]


def test_a_type_error_inside_a_callback_is_left_as_it_is(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        node.create_timer(0.1, lambda: "1" + 1)
        with pytest.raises(TypeError) as caught:
            rclpy.spin(node)
        found.append(getattr(caught.value, "__notes__", []))

    assert run(program) == [[]]


# ---------------------------------------------------------------- changes while spinning


def test_callbacks_may_make_and_destroy_things_even_themselves(run: Run) -> None:
    def program(found: list[str]) -> None:
        node = start()
        timers: dict[str, Any] = {}
        subscription = node.create_subscription(String, "topic", lambda _: found.append("never"), 10)
        publisher = node.create_publisher(String, "topic", 10)

        def once() -> None:
            found.append("once")
            node.destroy_timer(timers["once"])

        def destroy() -> None:
            found.append("destroy")
            node.destroy_timer(timers["destroy"])
            publisher.publish(String())
            node.destroy_subscription(subscription)

        def make() -> None:
            found.append("make")
            node.destroy_timer(timers["make"])
            node.create_timer(0.1, lambda: found.append("made"))

        timers["once"] = node.create_timer(0.1, once)
        timers["destroy"] = node.create_timer(0.1, destroy)
        timers["make"] = node.create_timer(0.1, make)
        rclpy.spin(node)

    assert run(program, seconds=0.75) == ["once", "destroy", "make"] + ["made"] * 6


def test_a_node_is_added_once_and_moves_from_one_executor_to_the_other(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        one, two = SingleThreadedExecutor(), SingleThreadedExecutor()
        found += [one.add_node(node), one.add_node(node), node.executor is one]
        found += [two.add_node(node), node.executor is two, one.get_nodes()]
        rclpy.spin_once(node, timeout_sec=0.1)  # takes it over, and gives it up again; the node remembers the last
        last = rclpy.get_global_executor()
        found += [node.executor is last, last.get_nodes(), two.get_nodes()]
        node.executor = one
        found += [node.executor is one, one.get_nodes() == [node]]
        node.executor = None
        found += [node.executor, one.get_nodes()]

    assert run(program) == [True, False, True, True, True, [], True, [], [], True, True, None, []]


def test_a_callback_that_waits_forever_after_its_program_has_ended_is_explained(
    run: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        client = node.create_client(AddTwoInts, "nobody")

        def tick() -> None:
            time.sleep(1.0)
            client.call(AddTwoInts.Request())

        node.create_timer(0.1, tick)
        executor = MultiThreadedExecutor(2)
        executor.add_node(node)
        executor.spin_once()

    run(program)
    assert "NeverWakes: this call of /nobody can never be answered" in capsys.readouterr().err


def test_only_nodes_can_be_spun(world: World) -> None:
    class Navigator(Node):
        def __init__(self) -> None:
            super().__init__("navigator")

    class Forgetful(Node):
        def __init__(self) -> None:
            pass

    rclpy.init()
    for value, hint in (
        (Navigator, "got the class Navigator; make an instance first: node = Navigator()"),
        (Forgetful(), "begin its __init__ with super().__init__('its_name')"),
        (None, "got None; after rclpy.init(), make one: node = rclpy.create_node('its_name')"),
    ):
        with pytest.raises(TypeError) as caught:
            rclpy.spin_once(value, timeout_sec=0)
        assert "a node is expected" in str(caught.value)
        assert hint in str(caught.value)


# ---------------------------------------------------------------- several threads


def two_slow_timers(run: Run, group: Callable[[], Any]) -> tuple[int, str]:
    """Two timers of 0.1 s whose callbacks sleep 0.25 s, in two threads: the most at once, and who begins when."""
    most = [0]

    def program(found: list[Any]) -> None:
        node, now, busy = start(), clock(), []
        shared = group()

        def tick(name: str) -> None:
            busy.append(name)
            most.append(len(busy))
            found.append(f"{name}{now():.2f}")
            time.sleep(0.25)
            busy.remove(name)

        for name in "AB":
            node.create_timer(0.1, lambda name=name: tick(name), callback_group=shared)
        executor = MultiThreadedExecutor(2)
        executor.add_node(node)
        executor.spin()

    found = run(program, seconds=1.2)
    return max(most), " ".join(found)


def test_in_one_exclusive_group_the_second_of_two_overloaded_timers_starves(run: Run) -> None:
    expected = (1, "A0.10 A0.35 A0.60 A0.85 A1.10")  # recorded: the same, each 0.01 s later
    assert two_slow_timers(run, lambda: None) == expected
    assert two_slow_timers(run, MutuallyExclusiveCallbackGroup) == expected


def test_in_a_reentrant_group_both_run_side_by_side(run: Run) -> None:
    expected = (2, "A0.10 B0.10 A0.35 B0.35 A0.60 B0.60 A0.85 B0.85 A1.10 B1.10")  # as recorded
    assert two_slow_timers(run, ReentrantCallbackGroup) == expected


def test_the_number_of_threads_is_checked(world: World) -> None:
    rclpy.init()
    with pytest.raises(ValueError, match="num_threads must be at least 1, got 0"):
        MultiThreadedExecutor(0)
    with pytest.warns(UserWarning, match="Use the SingleThreadedExecutor instead"):
        MultiThreadedExecutor(1)


# ---------------------------------------------------------------- spinning inside a callback


def heartbeat_while(run: Run, callback: Callable[[Node, list[Any]], object], **options: Any) -> list[Any]:
    """A 10 Hz heartbeat beside a callback at 0.35 s; what the callback found, and the beats in 2.5 s."""

    def program(found: list[Any]) -> None:
        node, now, beats = start(), clock(), []
        node.create_timer(0.1, lambda: beats.append(now()))
        group = options.get("group", lambda: None)()
        once = node.create_timer(0.35, lambda: (once.cancel(), callback(node, beats, found)), callback_group=group)
        while now() < 2.5:
            options.get("spin", rclpy.spin_once)(node, timeout_sec=0.01)
        found.append(len(beats))

    return run(program)


def test_spinning_for_a_future_in_a_callback_blocks_its_whole_group_until_the_timeout(run: Run) -> None:
    def callback(node: Node, beats: list[float], found: list[Any]) -> None:
        client = node.create_client(AddTwoInts, "add")
        node.create_service(AddTwoInts, "add", lambda request, response: response)
        future, now = client.call_async(AddTwoInts.Request()), clock()
        rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
        found.append((future.done(), future.result(), round(now(), 2), len(beats)))

    # recorded: done False None after 1.00 s, 3 beats so far, 16 in all (about 24 when nothing is blocked)
    (answer, beats) = heartbeat_while(run, callback)
    assert answer == (False, None, 1.0, 3)
    assert beats == pytest.approx(16, abs=1)


def test_without_a_timeout_that_would_hang_for_ever_so_it_is_explained(run: Run) -> None:
    def callback(node: Node, beats: list[float], found: list[Any]) -> None:
        client = node.create_client(AddTwoInts, "add")
        node.create_service(AddTwoInts, "add", lambda request, response: response)
        future = client.call_async(AddTwoInts.Request())
        with pytest.raises(NeverWakes) as caught:
            rclpy.spin_until_future_complete(node, future)
        found.append(str(caught.value))

    text, beats = heartbeat_while(run, callback)
    assert text.startswith("this callback spins until /add has answered, which can never happen")
    assert "callback group of its own" in text
    assert beats >= 24  # recorded: 3, the real one never comes back


def test_spinning_once_inside_a_callback_returns(run: Run) -> None:
    def callback(node: Node, beats: list[float], found: list[Any]) -> None:
        rclpy.spin_once(node, timeout_sec=0.1)
        found.append("returned")

    assert heartbeat_while(run, callback)[0] == "returned"


def test_a_rate_sleeps_in_one_thread_while_another_spins(run: Run) -> None:
    def callback(node: Node, beats: list[float], found: list[Any]) -> None:
        now, rate = clock(), node.create_rate(2)
        for _ in range(3):
            rate.sleep()
            found.append(round(now(), 2))

    executors = []

    def spin(node: Node, timeout_sec: float) -> None:
        if not executors:
            executors.append(MultiThreadedExecutor(2))
            executors[0].add_node(node)
        executors[0].spin_once(timeout_sec=timeout_sec)

    found = heartbeat_while(run, callback, spin=spin, group=MutuallyExclusiveCallbackGroup)
    assert found[:3] == [0.5, 1.0, 1.5]
    assert found[3] >= 24  # recorded: 25


def test_a_rate_in_the_only_thread_would_sleep_for_ever_so_it_is_explained(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        with pytest.raises(NeverWakes) as caught:
            node.create_rate(2).sleep()
        found.append(str(caught.value))
        with pytest.raises(ValueError, match="frequency must be > 0"):
            node.create_rate(0)

    (text,) = run(program)
    assert "no other thread is spinning the node" in text


# ---------------------------------------------------------------- ends


def test_spin_ends_with_an_exception_when_the_context_is_shut_down(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        node.create_timer(0.1, lambda: None)
        rclpy.get_default_context().on_shutdown(lambda: found.append("told"))
        node.create_timer(0.35, rclpy.shutdown)
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        executor.spin()  # it is not waiting just then, so it simply ends
        found.append(rclpy.ok())

    assert run(program) == ["told", False]


def test_a_waiting_spin_hears_of_a_shutdown_from_elsewhere(run: Run, world: World) -> None:
    contexts = []

    def program(found: list[Any]) -> None:
        node = start()
        contexts.append(rclpy.get_default_context())
        rclpy.spin(node)
        found.append("the spin function returns")

    def other_program(found: list[Any]) -> None:
        executor = SingleThreadedExecutor()
        executor.add_node(start())
        contexts.append(rclpy.get_default_context())
        try:
            executor.spin()
        except ExternalShutdownException:
            found.append("the executor raises")

    world.sim.call_later(500_000_000, lambda: [context.try_shutdown() for context in contexts])
    assert run(program, other_program) == ["the spin function returns", "the executor raises"]


def test_an_executor_that_is_shut_down_spins_no_more_and_says_so_only_to_those_who_wait_themselves(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        executor.shutdown()
        found.append(executor.get_nodes())
        executor.spin_once()
        executor.spin()
        executor.spin_until_future_complete(Future())
        with pytest.raises(ShutdownException):
            executor.wait_for_ready_callbacks()

    assert run(program) == [[]]


@pytest.mark.parametrize("kind", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_a_callback_that_shuts_its_executor_down_ends_the_spinning_in_silence(run: Run, kind: type[Executor]) -> None:
    def program(found: list[Any]) -> None:
        node, executor = start(), kind()
        executor.add_node(node)
        node.create_timer(0.1, executor.shutdown)
        executor.spin()
        found.append(rclpy.ok())

    assert run(program) == [True]


def test_a_spin_that_waits_ends_in_silence_when_its_executor_is_shut_down(run: Run, world: World) -> None:
    executors: list[Executor] = []

    def program(found: list[Any]) -> None:
        node, executor = start(), SingleThreadedExecutor()
        executors.append(executor)
        executor.add_node(node)
        executor.spin()
        found.append("ended")

    world.sim.call_later(500_000_000, lambda: executors[0].shutdown())
    assert run(program) == ["ended"]


def test_an_executor_of_ones_own_is_built_from_its_parts(run: Run) -> None:
    class Chatty(SingleThreadedExecutor):
        def spin_once(self, timeout_sec: float | None = None) -> None:
            try:
                handler, entity, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
            except TimeoutException:
                return
            log.append((node.get_name(), entity))
            handler()

    log: list[Any] = []

    def program(found: list[Any]) -> None:
        node = start()
        timer = node.create_timer(0.1, lambda: found.append("tick"))
        executor = Chatty()
        executor.add_node(node)
        executor.spin_once(timeout_sec=0.05)
        executor.spin_once(timeout_sec=0.2)
        found.append(log == [("n", timer)])
        node.create_timer(0.2, rclpy.shutdown)
        executor.spin()

    assert run(program) == ["tick", True, "tick", "tick"]


# ---------------------------------------------------------------- a coroutine that only lets others go first


@pytest.mark.parametrize("kind", [SingleThreadedExecutor, lambda: MultiThreadedExecutor(2)])
def test_a_coroutine_that_lets_others_go_first_goes_on_with_the_next_spin(
    run: Run, kind: Callable[[], Executor]
) -> None:
    def program(found: list[Any]) -> None:
        node, executor = start(), kind()
        executor.add_node(node)

        async def in_three_steps() -> None:
            for step in range(3):
                found.append(step)
                await asyncio.sleep(0)

        bell = node.create_guard_condition(in_three_steps)
        bell.trigger()
        for timeout in (0, 0.1, 0, 0):
            executor.spin_once(timeout_sec=timeout)
            time.sleep(0.01)
            found.append("spun")

    assert run(program) == [0, "spun", 1, "spun", 2, "spun", "spun"]


def test_a_coroutine_that_looks_again_and_again_does_not_hold_time_up(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now, looks = start(), clock(), [0]

        async def wait_for_half_a_second() -> None:
            while now() < 0.5:
                looks[0] += 1
                await asyncio.sleep(0)
            found.append((now(), 4_000 < looks[0] < 5_100))  # every 0.1 ms
            rclpy.shutdown()

        node.create_timer(0.1, lambda: None)
        rclpy.get_global_executor().create_task(wait_for_half_a_second)
        rclpy.spin(node)

    assert run(program) == [(0.5, True)]


def test_a_coroutine_that_lets_others_go_first_goes_on_at_once_each_time(run: Run) -> None:
    def program(found: list[Any]) -> None:
        node, now = start(), clock()

        async def tick() -> None:
            begun = now()
            await asyncio.sleep(0)
            found.append((begun, now()))

        node.create_timer(0.1, tick)
        rclpy.spin(node)

    assert run(program, seconds=0.45) == [(tick, tick) for tick in (0.1, 0.2, 0.3, 0.4)]


# ---------------------------------------------------------------- a node between two spins


@pytest.mark.parametrize("another", [False, True])
def test_what_comes_while_a_node_is_not_spun_waits_for_the_next_executor(run: Run, another: bool) -> None:
    def program(found: list[Any]) -> None:
        node = start()
        first, second = SingleThreadedExecutor(), SingleThreadedExecutor()
        publisher = node.create_publisher(String, "old", 10)
        later = node.create_publisher(String, "new", 10)
        node.create_subscription(String, "old", lambda message: found.append(message.data), 10)
        first.add_node(node)
        first.remove_node(node)
        node.create_subscription(String, "new", lambda message: found.append(message.data), 10)  # made in between
        later.publish(String(data="to the new one"))
        publisher.publish(String(data="to the old one"))
        first.spin_once(timeout_sec=0.1)
        found.append("not yet")
        executor = second if another else first
        executor.add_node(node)
        for _ in range(3):
            executor.spin_once(timeout_sec=0.0)
        executor.remove_node(node)
        publisher.publish(String(data="not heard"))
        executor.spin_once(timeout_sec=0.1)

    assert run(program) == ["not yet", "to the old one", "to the new one"]


@pytest.mark.parametrize(("patience", "told"), [(0.0, 1), (60.0, 0)])
def test_a_cell_that_spins_for_long_says_once_how_to_stop_it(
    world: World, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], patience: float, told: int
) -> None:
    monkeypatch.setattr(rclpy._blocking, "SAY_AFTER", patience)
    executor, node = SingleThreadedExecutor(), start()
    executor.add_node(node)
    node.create_timer(0.1, executor.shutdown)
    executor.spin()
    assert capsys.readouterr().out.count("This cell spins until you stop it: the ■ button above") == told
