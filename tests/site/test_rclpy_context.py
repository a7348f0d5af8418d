"""From init to shutdown, nodes that are gone, and points in time, against what a real rclpy did."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import builtin_interfaces.msg
import pytest
import rclpy
from rclpy.clock import Clock, ClockType, ROSClock
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.exceptions import InvalidHandle, NotInitializedException, RCLError
from rclpy.node import Node
from rclpy.time import Time
from std_msgs.msg import String
from std_srvs.srv import Trigger

from turtle_lesson.ros.runtime.world import World

Run = Callable[..., list[Any]]
DESTROYED = "cannot use Destroyable because destruction was requested"


def message_of(kind: type[Exception], call: Callable[[], object]) -> str:
    """The text of the exception, of exactly this type, that a call raises."""
    with pytest.raises(kind) as caught:
        call()
    assert caught.type is kind
    return str(caught.value)


# ---------------------------------------------------------------- init and shutdown


def test_before_init_there_are_no_nodes(world: World) -> None:
    assert not rclpy.ok()
    text = message_of(NotInitializedException, lambda: Node("n"))
    assert text == "('rclpy.init() has not been called', 'cannot create node')"
    text = message_of(RuntimeError, rclpy.shutdown)
    assert text == "Context must be initialized before it can be shutdown"
    rclpy.try_shutdown()
    text = message_of(TypeError, lambda: rclpy.spin_once(None))  # the real one complains of a context manager
    assert text == "a node is expected, got None; after rclpy.init(), make one: node = rclpy.create_node('its_name')"


def test_init_is_called_once(world: World) -> None:
    rclpy.init()
    assert rclpy.ok()
    assert message_of(RuntimeError, rclpy.init) == "Context.init() must only be called once"
    assert rclpy.ok()


def test_shutdown_is_called_once_too_but_there_is_try_shutdown(world: World) -> None:
    rclpy.init()
    rclpy.shutdown()
    assert not rclpy.ok()
    text = message_of(RuntimeError, rclpy.shutdown)
    assert text == "Context must be initialized before it can be shutdown"
    rclpy.try_shutdown()
    with pytest.raises(NotInitializedException):
        Node("n")


def test_after_a_shutdown_one_can_begin_anew(world: World) -> None:
    for _ in range(2):
        rclpy.init()
        node = rclpy.create_node("n")
        assert node.get_node_names() == ["n"]
        rclpy.shutdown()


def test_init_as_a_context_manager_shuts_down_at_its_end(world: World) -> None:
    with rclpy.init():
        assert rclpy.ok()
    assert not rclpy.ok()


def test_a_context_of_ones_own_lives_apart_from_the_default_one(world: World) -> None:
    context = rclpy.Context()
    rclpy.init(context=context, args=["prog", "--ros-args", "-r", "__node:=mine"])
    assert (context.ok(), rclpy.ok()) == (True, False)
    assert Node("n", context=context).get_name() == "mine"
    rclpy.shutdown(context=context)
    assert not context.ok()


def test_each_process_has_its_own_context(run: Run) -> None:
    def one(found: list[Any]) -> None:
        rclpy.init()
        time.sleep(2.0)
        found.append(("one", rclpy.ok()))

    def other(found: list[Any]) -> None:
        found.append(("other", rclpy.ok()))
        rclpy.init()
        rclpy.shutdown()

    assert run(one, other) == [("other", False), ("one", True)]


def test_a_process_that_ends_takes_its_nodes_along(run: Run) -> None:
    def short(found: list[Any]) -> None:
        rclpy.init()
        rclpy.create_node("short").create_publisher(String, "chatter", 10)
        time.sleep(1.0)

    def watcher(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("watcher")
        for _ in range(2):
            time.sleep(0.6)
            found.append((sorted(node.get_node_names()), node.count_publishers("chatter")))

    assert run(short, watcher) == [(["short", "watcher"], 1), (["watcher"], 0)]


# ---------------------------------------------------------------- nodes that are gone


def test_a_destroyed_node_can_neither_make_nor_publish_anything(world: World) -> None:
    rclpy.init()
    node = rclpy.create_node("n")
    publisher = node.create_publisher(String, "topic", 10)
    node.destroy_node()
    assert message_of(InvalidHandle, lambda: publisher.publish(String())) == DESTROYED
    assert message_of(InvalidHandle, lambda: node.create_publisher(String, "topic", 10)) == DESTROYED
    assert message_of(InvalidHandle, lambda: node.create_subscription(String, "topic", None, 10)) == DESTROYED
    assert message_of(InvalidHandle, lambda: node.create_guard_condition(lambda: None)) == DESTROYED
    node.create_timer(0.1, lambda: None)  # that is no part of the graph
    assert issubclass(InvalidHandle, RuntimeError)
    node.destroy_node()  # once more does no harm


def test_after_the_shutdown_what_is_left_can_be_looked_at_but_nothing_sent(world: World) -> None:
    """As on a robot after Ctrl-C: what tidies up works, what needs the graph says that the context is invalid."""
    rclpy.init()
    node = rclpy.create_node("n")
    node.declare_parameter("speed", 1.5)
    publisher, timer = node.create_publisher(String, "topic", 10), node.create_timer(0.1, lambda: None)
    client = node.create_client(Trigger, "ask")
    rclpy.shutdown()
    timer.cancel()
    timer.reset()
    assert (node.get_name(), publisher.topic_name, client.service_name) == ("n", "/topic", "/ask")
    assert node.get_parameter("speed").value == 1.5
    assert not client.call_async(Trigger.Request()).done()
    for call, doing in (
        (lambda: publisher.publish(String()), "Failed to publish: publisher's"),
        (publisher.get_subscription_count, "failed to get subscription count: publisher's"),
        (client.service_is_ready, "failed to check service availability: rcl node's"),
        (lambda: node.create_publisher(String, "x", 1), "Failed to create publisher: rcl node's"),
        (lambda: node.create_subscription(String, "x", print, 1), "Failed to create subscription: rcl node's"),
        (lambda: node.create_client(Trigger, "x"), "failed to create client: rcl node's"),
        (lambda: node.create_service(Trigger, "x", print), "failed to create service: rcl node's"),
        (node.get_node_names, "Failed to get node names: rcl node's"),
        (lambda: node.count_publishers("x"), "Error in rcl_count_publishers: rcl node's"),
    ):
        assert message_of(RCLError, call) == f"{doing} context is invalid"
    text = message_of(RCLError, lambda: node.create_timer(1.0, lambda: None))
    assert text.startswith("failed to create timer: the given context is not valid, either rcl_init() was not called")
    node.destroy_publisher(publisher)
    node.destroy_timer(timer)
    node.destroy_node()
    for gone in (lambda: publisher.publish(String()), timer.cancel):
        assert message_of(InvalidHandle, gone) == DESTROYED
    assert message_of(InvalidHandle, client.service_is_ready) == DESTROYED
    assert message_of(InvalidHandle, node.get_name) == DESTROYED


def test_a_context_ends_once(world: World) -> None:
    context = Context()
    assert message_of(RuntimeError, context.shutdown) == "Context must be initialized before it can be shutdown"
    context.init()
    context.shutdown()
    text = message_of(RCLError, context.shutdown)
    assert text == "failed to shutdown: rcl_shutdown already called on the given context"
    context.try_shutdown()
    assert message_of(RCLError, context.get_domain_id).startswith("Failed to get domain id")


def test_a_node_can_be_a_context_manager(world: World) -> None:
    rclpy.init()
    watcher = rclpy.create_node("watcher")
    with Node("short") as node:
        assert watcher.get_node_names() == ["watcher", "short"]
        assert repr(node) == "<Node /short>"
    assert watcher.get_node_names() == ["watcher"]


def test_destroying_something_of_another_node_does_nothing(world: World) -> None:
    rclpy.init()
    node, other = rclpy.create_node("n"), rclpy.create_node("other")
    publisher, timer = node.create_publisher(String, "topic", 10), node.create_timer(0.1, lambda: None)
    assert not other.destroy_publisher(publisher)
    assert not other.destroy_timer(timer)
    assert node.destroy_publisher(publisher)
    assert not node.destroy_publisher(publisher)
    assert node.destroy_timer(timer)


# ---------------------------------------------------------------- clocks


def test_a_node_s_clock_shows_virtual_time(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        clock = rclpy.create_node("n").get_clock()
        began = clock.now()
        time.sleep(1.5)
        found += [round((clock.now() - began).nanoseconds, -4), clock.now().clock_type, began.seconds_nanoseconds()[0]]
        found.append(type(clock.now().to_msg()).__name__)

    assert run(program) == [1_500_000_000, ClockType.ROS_TIME, 1_800_000_000, "Time"]


def test_looking_at_the_clock_takes_a_moment_so_that_a_busy_wait_ends(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        clock = rclpy.create_node("n").get_clock()
        deadline = clock.now() + Duration(seconds=0.001)
        while clock.now() < deadline:
            found.append("looked")

    assert len(run(program)) == 999


def test_clocks_sleep(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        clock, began = ROSClock(), time.time()
        found.append(clock.sleep_for(Duration(seconds=0.5)))
        found.append(clock.sleep_until(clock.now() + Duration(seconds=0.25)))
        found.append(round(time.time() - began, 3))
        with pytest.raises(ValueError, match="clock type does not match"):
            clock.sleep_until(Clock(clock_type=ClockType.STEADY_TIME).now())

    assert run(program) == [True, True, 0.75]


# ---------------------------------------------------------------- time and duration


def test_how_times_and_durations_are_shown() -> None:
    assert repr(Duration(seconds=1.5)) == "Duration(nanoseconds=1500000000)"
    assert repr(Time(seconds=3)) == "Time(nanoseconds=3000000000, clock_type=SYSTEM_TIME)"


def test_arithmetic_with_times() -> None:
    assert Time(seconds=3) - Time(seconds=1) == Duration(seconds=2)
    assert Time(seconds=1) - Time(seconds=3) == Duration(seconds=-2)
    assert Time(seconds=3) - Duration(seconds=1) == Time(seconds=2)
    assert Time(seconds=3) + Duration(seconds=1) == Duration(seconds=1) + Time(seconds=3) == Time(seconds=4)
    assert Time(seconds=1) < Time(seconds=2) <= Time(seconds=2)
    assert Duration(seconds=1) + Duration(seconds=2) == Duration(seconds=3)


@pytest.mark.parametrize(
    ("call", "kind", "text"),
    [
        (
            lambda: Time(seconds=3) - Time(seconds=1, clock_type=ClockType.ROS_TIME),
            TypeError,
            "Can't subtract times with different clock types",
        ),
        (
            lambda: Time(seconds=3) < Time(seconds=1, clock_type=ClockType.ROS_TIME),
            TypeError,
            "Can't compare times with different clock types",
        ),
        (
            lambda: Time(seconds=3) + 1,
            TypeError,
            "unsupported operand type(s) for +: 'Time' and 'int'",
        ),
        (
            lambda: Time(seconds=3) - Duration(seconds=4),
            ValueError,
            "Subtraction leads to negative time.",
        ),
        (lambda: Time(seconds=-1), ValueError, "Seconds value must not be negative"),
        (
            lambda: Time(nanoseconds=2**63 - 1) + Duration(nanoseconds=1),
            OverflowError,
            "Total nanoseconds value is too large to store in C time point.",
        ),
        (
            lambda: Duration(seconds=1) + 1,
            TypeError,
            "unsupported operand type(s) for +: 'Duration' and 'int'",
        ),
        (
            lambda: Time.from_msg(builtin_interfaces.msg.Duration()),
            TypeError,
            "Must pass a builtin_interfaces.msg.Time object, got builtin_interfaces.msg.Duration(sec=0, nanosec=0)",
        ),
    ],
)
def test_arithmetic_that_makes_no_sense(call: Callable[[], object], kind: type[Exception], text: str) -> None:
    assert message_of(kind, call) == text


def test_times_go_over_the_wire_and_back() -> None:
    for value in (Time(seconds=3, nanoseconds=7, clock_type=ClockType.ROS_TIME), Duration(seconds=-1.5)):
        assert type(value).from_msg(value.to_msg()) == value
