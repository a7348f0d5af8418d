"""Deadlines, leases and lifespans in virtual time, and the callbacks that hear of them.

The programs are in the style of ROS's quality_of_service_demo; counts follow the DDS specification and Cyclone DDS.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from hypothesis import given
from hypothesis import strategies as st
from rclpy.duration import Duration
from rclpy.event_handler import (
    EventHandler,
    PublisherEventCallbacks,
    QoSPublisherEventType,
    QoSSubscriptionEventType,
    SubscriptionEventCallbacks,
    UnsupportedEventTypeError,
)
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSPolicyKind, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Int32, String

from turtle_lesson.ros.runtime.world import World, open_world

Run = Callable[..., list[Any]]
Capture = pytest.CaptureFixture[str]
EPOCH = 1_800_000_000


def now() -> float:
    """The robot time, to the millisecond."""
    return round(time.time() - EPOCH, 3)


def talker(topic: str, qos: QoSProfile, silent: tuple[float, float] = (99, 99), **events: Any) -> Callable[..., None]:
    """A program that publishes twice a second, but not between two times. `events` put what they are told in the list."""

    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("talker")
        callbacks = {name: lambda event, name=name: found.append((now(), "talker", event)) for name in events}
        publisher = node.create_publisher(Int32, topic, qos, event_callbacks=PublisherEventCallbacks(**callbacks))

        def tick() -> None:
            if not silent[0] < now() < silent[1]:
                publisher.publish(Int32(data=round(now() * 2)))

        node.create_timer(0.5, tick)
        rclpy.spin(node)

    return program


def listener(topic: str, qos: QoSProfile, hear: bool = False, **events: Any) -> Callable[..., None]:
    """A program that puts what its events are told, and perhaps the messages, in the list."""

    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("listener")
        callbacks = {name: lambda event, name=name: found.append((now(), "listener", event)) for name in events}

        def take(message: Any) -> None:
            if hear:
                found.append((now(), message.data))

        node.create_subscription(Int32, topic, take, qos, event_callbacks=SubscriptionEventCallbacks(**callbacks))
        rclpy.spin(node)

    return program


# ---------------------------------------------------------------- deadlines

LIMIT = QoSProfile(depth=10, deadline=Duration(seconds=0.6))


def test_a_pause_misses_as_many_deadlines_as_fit_into_it(run: Run) -> None:
    speak = talker("x", LIMIT, silent=(2.1, 3.9), deadline=True)
    assert run(speak, listener("x", LIMIT, deadline=True), seconds=5.0) == [
        (2.6, "talker", (1, 1)),
        (2.6, "listener", (1, 1)),
        (3.2, "talker", (2, 1)),
        (3.2, "listener", (2, 1)),
        (3.8, "talker", (3, 1)),
        (3.8, "listener", (3, 1)),
    ]


def test_nothing_is_late_before_the_first_message_and_after_the_publisher_has_gone(run: Run) -> None:
    def brief(found: list[Any]) -> None:
        time.sleep(3.0)
        rclpy.init()
        publisher = rclpy.create_node("brief").create_publisher(Int32, "x", LIMIT)
        publisher.publish(Int32())
        time.sleep(1.0)

    assert run(brief, listener("x", LIMIT, deadline=True)) == [(3.6, "listener", (1, 1))]


def test_exactly_one_period_is_no_delay(run: Run) -> None:
    even = QoSProfile(depth=10, deadline=Duration(seconds=0.5))
    assert run(talker("x", even, deadline=True), listener("x", even, deadline=True)) == []


def test_a_callback_that_comes_late_is_told_all_at_once(run: Run) -> None:
    def busy(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("busy")
        events = PublisherEventCallbacks(
            deadline=lambda event: found.append((event.total_count, event.total_count_change))
        )
        node.create_publisher(Int32, "x", LIMIT, event_callbacks=events).publish(Int32())
        time.sleep(2.0)
        rclpy.spin(node)

    assert run(busy, seconds=2.1) == [(3, 3)]


@pytest.mark.parametrize("offered", [0.0, 2.0])
def test_who_promises_too_little_is_not_heard(run: Run, capsys: Capture, offered: float) -> None:
    slow, strict = (QoSProfile(depth=10, deadline=Duration(seconds=limit)) for limit in (offered, 1.0))
    assert run(talker("x", slow), listener("x", strict, hear=True, deadline=True), seconds=3.0) == []
    first, second = capsys.readouterr().err.splitlines()
    assert "[talker]: New subscription discovered on topic 'x', requesting incompatible QoS." in first
    assert second.endswith("No messages will be received from it. Last incompatible policy: DEADLINE")


# ---------------------------------------------------------------- liveliness

LEASE = QoSProfile(
    depth=10, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC, liveliness_lease_duration=Duration(seconds=0.8)
)


def test_who_shows_no_life_is_taken_for_dead_until_it_speaks_again(run: Run) -> None:
    speak = talker("x", LEASE, silent=(2.1, 4.4), liveliness=True)
    found = run(speak, listener("x", LEASE, liveliness=True), seconds=6.0)
    assert [entry for entry in found if entry[1] == "talker"] == [(2.8, "talker", (1, 1))]
    # alive, not alive, and how both have changed
    assert [entry for entry in found if entry[1] == "listener"] == [
        (0.0, "listener", (1, 0, 1, 0)),
        (2.8, "listener", (0, 1, -1, 1)),
        (4.5, "listener", (1, 0, 1, -1)),
    ]


def test_it_is_enough_to_say_that_one_is_alive(run: Run) -> None:
    def quiet(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("quiet")
        events = PublisherEventCallbacks(liveliness=lambda event: found.append(now()))
        publisher = node.create_publisher(Int32, "x", LEASE, event_callbacks=events)
        beat = node.create_timer(0.5, publisher.assert_liveliness)
        node.create_timer(3.2, beat.cancel)
        rclpy.spin(node)

    assert run(quiet, seconds=9.0) == [3.8]


def test_who_leaves_is_counted_no_more(run: Run) -> None:
    automatic = QoSProfile(depth=10, liveliness_lease_duration=Duration(seconds=1))

    def brief(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("brief")
        node.create_publisher(Int32, "x", automatic)
        time.sleep(5.0)  # its process lives, and so does it
        node.destroy_node()
        time.sleep(1.0)

    found = run(brief, listener("x", automatic, liveliness=True))
    assert found == [(0.0, "listener", (1, 0, 1, 0)), (5.0, "listener", (0, 0, -1, 0))]


def test_from_the_dead_no_message_is_late(run: Run) -> None:
    both = QoSProfile(
        depth=10,
        deadline=Duration(seconds=0.6),
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=1.5),
    )
    found = run(talker("x", both, silent=(2.1, 20)), listener("x", both, deadline=True))
    assert found == [(2.6, "listener", (1, 1)), (3.2, "listener", (2, 1))]


@pytest.mark.parametrize(
    "offered",
    [{}, {"liveliness_lease_duration": Duration(seconds=0.5)}, {"liveliness": LivelinessPolicy.MANUAL_BY_TOPIC}],
)
def test_a_lease_is_compared_kind_and_length(run: Run, capsys: Capture, offered: dict[str, Any]) -> None:
    assert run(talker("x", QoSProfile(depth=1, **offered)), listener("x", LEASE, hear=True), seconds=2.0) == []
    assert "Last incompatible policy: LIVELINESS" in capsys.readouterr().err


# ---------------------------------------------------------------- lifespans


def lasting(seconds: float, depth: int = 10) -> QoSProfile:
    """A latched profile with a lifespan."""
    return QoSProfile(
        depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(nanoseconds=round(seconds * 1e9))
    )


def numbers_heard(world: World, qos: QoSProfile, subscribe_after: float, nap: float = 0.0) -> list[int]:
    """What a subscription gets of a number published each 0.1 s, made after a while, and first spun after a nap."""
    found: list[int] = []

    def program() -> None:
        rclpy.init()
        node, late = rclpy.create_node("talker"), rclpy.create_node("late")
        publisher = node.create_publisher(Int32, "x", qos)
        for number in range(round(subscribe_after * 10)):
            publisher.publish(Int32(data=number))
            time.sleep(0.1)
        late.create_subscription(Int32, "x", lambda message: found.append(message.data), lasting(0, 100))
        time.sleep(nap)
        executor = SingleThreadedExecutor()
        executor.add_node(late)
        executor.spin()

    world.spawn(program, name="program")
    world.sim.run_until(world.now + 20_000_000_000)
    return found


def test_late_joiners_get_only_what_is_still_good(world: World) -> None:
    assert numbers_heard(world, lasting(0.35), 2.0) == [17, 18, 19]  # published 0.3, 0.2 and 0.1 s ago
    assert numbers_heard(world, lasting(0), 2.0) == list(range(10, 20))


def test_what_waits_too_long_in_the_queue_expires_there(world: World) -> None:
    assert numbers_heard(world, lasting(0.35), 2.0, nap=0.2) == [19]
    assert numbers_heard(world, lasting(0.35), 2.0, nap=0.3) == []


@given(
    lifespan=st.integers(5, 150).map(lambda tenth: tenth / 100),
    after=st.integers(1, 20).map(lambda tenths: tenths / 10),
    nap=st.integers(0, 20).map(lambda tenths: tenths / 10),
)
def test_nothing_older_than_its_lifespan_is_ever_delivered(lifespan: float, after: float, nap: float) -> None:
    world = open_world()
    heard = numbers_heard(world, lasting(lifespan, 100), after, nap)
    ages = [after - number * 0.1 + nap + 0.00011 for number in range(round(after * 10))]
    assert heard == [number for number, age in enumerate(ages) if age < lifespan]
    world.close()


def test_times_stay_with_their_messages_when_others_expire(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        short = node.create_publisher(Int32, "x", QoSProfile(depth=10, lifespan=Duration(seconds=0.2)))
        lasts = node.create_publisher(Int32, "x", 10)

        def hear(message: Any, info: dict[str, int]) -> None:
            found.append((message.data, round(info["source_timestamp"] / 1e9 - EPOCH, 3)))

        node.create_subscription(Int32, "x", hear, 10)
        for number in range(6):
            (short if number % 2 else lasts).publish(Int32(data=number))
            time.sleep(0.1)
        rclpy.spin(node)

    assert run(program) == [(0, 0.0), (2, 0.2), (4, 0.4), (5, 0.5)]


# ---------------------------------------------------------------- partners


def test_partners_that_do_not_fit_are_told_to_whoever_asks(run: Run, capsys: Capture) -> None:
    hasty = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    found = run(
        talker("x", hasty, incompatible_qos=True),
        listener("x", QoSProfile(depth=1), incompatible_qos=True),
        listener("x", QoSProfile(depth=1), incompatible_qos=True),
        seconds=2.0,
    )
    kind = QoSPolicyKind.RELIABILITY
    told = [event for _, who, event in found if who == "talker"]
    assert [(event.total_count, event.last_policy_kind) for event in told][-1] == (2, kind)
    assert sum(event.total_count_change for event in told) == 2
    assert [event for _, who, event in found if who == "listener"] == [(1, 1, kind), (1, 1, kind)]
    assert capsys.readouterr().err == ""  # who asks to be told hears no warning


def test_warnings_can_be_left_out(run: Run, capsys: Capture) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        hasty = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        quiet = {"event_callbacks": PublisherEventCallbacks(use_default_callbacks=False)}
        found.append(len(node.create_publisher(Int32, "x", hasty, **quiet).event_handlers))
        silent = SubscriptionEventCallbacks(use_default_callbacks=False)
        found.append(len(node.create_subscription(Int32, "x", print, 1, event_callbacks=silent).event_handlers))
        rclpy.spin(node)

    assert run(program) == [0, 0]
    assert capsys.readouterr().err == ""


def test_connections_come_and_go(run: Run) -> None:
    def visitor(found: list[Any]) -> None:
        time.sleep(1.0)
        rclpy.init()
        node = rclpy.create_node("visitor")
        subscription = node.create_subscription(Int32, "x", print, 1)
        time.sleep(1.0)
        node.destroy_subscription(subscription)
        node.create_subscription(String, "y", print, 1)
        time.sleep(1.0)
        node.create_publisher(Int32, "x", 1)
        time.sleep(10)

    plain = QoSProfile(depth=1)
    found = run(
        talker("x", plain, silent=(0, 99), matched=True), listener("x", plain, matched=True), visitor, seconds=4.0
    )
    assert [entry[::2] for entry in found if entry[1] == "talker"] == [
        (0.0, (1, 1, 1, 1)),  # ever, now; what is new of each
        (1.0, (2, 2, 1, 1)),
        (2.0, (2, 1, 0, -1)),
    ]
    assert [entry[::2] for entry in found if entry[1] == "listener"] == [(0.0, (1, 1, 1, 1)), (3.0, (2, 2, 1, 1))]


def test_another_type_is_told_only_to_whoever_asks(run: Run, capsys: Capture) -> None:
    def words(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("words")
        node.create_subscription(String, "x", print, 1)
        rclpy.spin(node)

    found = run(talker("x", QoSProfile(depth=1), incompatible_type=True), words, seconds=1.0)
    assert found == [(0.0, "talker", (1, 1))]
    assert capsys.readouterr().err == ""  # as Humble: no word


# ---------------------------------------------------------------- handlers


def test_each_callback_has_a_handler_of_its_own(world: World) -> None:
    rclpy.init()
    node = rclpy.create_node("n")
    callbacks = PublisherEventCallbacks()
    assert len(node.create_publisher(Int32, "x", 10, event_callbacks=callbacks).event_handlers) == 1
    callbacks.deadline = callbacks.liveliness = callbacks.incompatible_qos = print
    publisher = node.create_publisher(Int32, "x", 10, event_callbacks=callbacks)
    assert [handler.event_type for handler in publisher.event_handlers] == list(QoSPublisherEventType)[:3]
    everything = SubscriptionEventCallbacks(
        deadline=print, liveliness=print, message_lost=print, incompatible_type=print, matched=print
    )
    subscription = node.create_subscription(Int32, "x", print, 10, event_callbacks=everything)
    assert {handler.event_type for handler in subscription.event_handlers} == set(QoSSubscriptionEventType)
    assert set(subscription.event_handlers + publisher.event_handlers) <= set(node._ros_waiting_entities)
    node.destroy_subscription(subscription)
    node.destroy_publisher(publisher)
    assert not set(subscription.event_handlers + publisher.event_handlers) & set(node._ros_waiting_entities)


def test_a_coroutine_may_hear_of_events(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")

        async def told(event: Any) -> None:
            found.append(event.total_count)

        node.create_subscription(Int32, "x", print, 10, event_callbacks=SubscriptionEventCallbacks(matched=told))
        node.create_publisher(Int32, "x", 10)
        rclpy.spin(node)

    assert run(program) == [1]


def test_humbles_names_are_the_same_things() -> None:
    from rclpy import event_handler, qos_event

    assert qos_event.SubscriptionEventCallbacks is event_handler.SubscriptionEventCallbacks
    assert qos_event.QoSEventHandler is EventHandler
    info = qos_event.QoSLivelinessChangedInfo(alive_count=1, alive_count_change=1)
    assert str(info) == (
        "QoSLivelinessChangedInfo(alive_count=1, not_alive_count=0, alive_count_change=1, not_alive_count_change=0)"
    )


def test_what_makes_no_sense_says_so(world: World) -> None:
    rclpy.init()
    node = rclpy.create_node("n")
    with pytest.raises(TypeError, match=r"must be such as PublisherEventCallbacks\(deadline=…\), got Subscription"):
        node.create_publisher(Int32, "x", 10, event_callbacks=SubscriptionEventCallbacks())  # type: ignore[arg-type]
    assert node.count_publishers("x") == 0
    with pytest.raises(TypeError, match="unexpected keyword argument 'deadlin'"):
        SubscriptionEventCallbacks(deadlin=print)  # type: ignore[call-arg]
    subscription = node.create_subscription(Int32, "x", print, 10)
    with pytest.raises(UnsupportedEventTypeError, match=r"one of QoSSubscriptionEventType is expected, got .*MATCHED"):
        EventHandler(
            callback_group=node.default_callback_group,
            callback=print,
            event_type=QoSPublisherEventType.RCL_PUBLISHER_MATCHED,
            parent_impl=subscription,
        )
