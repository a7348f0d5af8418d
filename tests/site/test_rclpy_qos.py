"""Quality of service: who hears whom, what waits in queues and what is lost, against recordings of a real rclpy."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import pytest
import rclpy
from rclpy.exceptions import RCLError
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    InvalidQoSProfileException,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_parameters,
    qos_profile_sensor_data,
    qos_profile_services_default,
    qos_profile_system_default,
)
from std_msgs.msg import Int32, String

from turtle_lesson.ros.runtime.world import World

Run = Callable[..., list[Any]]
Capture = pytest.CaptureFixture[str]
BEST_EFFORT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
LATCHED = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def listener(kind: type, topic: str, qos: Any, delay: float = 0.0) -> Callable[[list[Any]], None]:
    """A program that puts the data of every message of a topic in its list."""

    def program(found: list[Any]) -> None:
        time.sleep(delay)
        rclpy.init()
        node = rclpy.create_node("listener")
        node.create_subscription(kind, topic, lambda message: found.append(message.data), qos)
        rclpy.spin(node)

    return program


# ---------------------------------------------------------------- incompatible


@pytest.mark.parametrize(
    ("topic", "offered", "requested", "policy"),
    [("qt", BEST_EFFORT, 10, "RELIABILITY"), ("qd", 10, LATCHED, "DURABILITY")],
)
def test_ends_that_do_not_go_together_are_warned_and_nothing_is_received(
    run: Run, capsys: Capture, topic: str, offered: Any, requested: Any, policy: str
) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        publishing, hearing = rclpy.create_node("qos_pub"), rclpy.create_node("qos_sub")
        publisher = publishing.create_publisher(String, topic, offered)
        hearing.create_subscription(String, topic, found.append, requested)
        publishing.create_timer(0.1, lambda: publisher.publish(String()))
        executor = SingleThreadedExecutor()
        executor.add_node(publishing)
        executor.add_node(hearing)
        executor.spin()

    assert run(program, seconds=1.0) == []
    lines = [line.partition("] ")[2].partition("] ")[2] for line in capsys.readouterr().err.splitlines()]
    assert lines == [
        f"[qos_pub]: New subscription discovered on topic '{topic}', requesting incompatible QoS. No messages will be "
        f"sent to it. Last incompatible policy: {policy}",
        f"[qos_sub]: New publisher discovered on topic '{topic}', offering incompatible QoS. No messages will be "
        f"received from it. Last incompatible policy: {policy}",
    ]


def test_the_warning_is_only_heard_by_a_node_that_is_spun(run: Run, capsys: Capture) -> None:
    def deaf(found: list[Any]) -> None:
        rclpy.init()
        publisher = rclpy.create_node("deaf").create_publisher(Int32, "topic", BEST_EFFORT)
        while True:
            publisher.publish(Int32())
            time.sleep(0.1)

    assert run(deaf, listener(Int32, "topic", 10), seconds=1.0) == []
    (line,) = capsys.readouterr().err.splitlines()
    assert "[listener]: New publisher discovered" in line


@pytest.mark.parametrize(
    ("offered", "requested", "heard"),
    [
        (10, 10, True),
        (10, BEST_EFFORT, True),
        (BEST_EFFORT, BEST_EFFORT, True),
        (BEST_EFFORT, 10, False),
        (LATCHED, 10, True),
        (10, LATCHED, False),
        (LATCHED, BEST_EFFORT, True),
        (qos_profile_sensor_data, qos_profile_system_default, False),
    ],
)
def test_who_hears_whom(world: World, offered: Any, requested: Any, heard: bool) -> None:
    rclpy.init()
    node = rclpy.create_node("n")
    publisher = node.create_publisher(Int32, "topic", offered)
    subscription = node.create_subscription(Int32, "topic", None, requested)
    assert publisher.get_subscription_count() == heard
    assert subscription.get_publisher_count() == heard


# ---------------------------------------------------------------- late joiners


def test_a_late_joiner_gets_what_a_latched_topic_has_kept(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        publisher = rclpy.create_node("n").create_publisher(String, "latched", LATCHED)
        for number in range(5):
            publisher.publish(String(data=str(number)))
        time.sleep(5)

    assert run(program, listener(String, "latched", LATCHED, delay=1.0)) == ["2", "3", "4"]
    assert run(program, listener(String, "latched", 10, delay=1.0)) == []
    hasty = QoSProfile(depth=3, reliability=ReliabilityPolicy.BEST_EFFORT, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    assert run(program, listener(String, "latched", hasty, delay=1.0)) == []  # one has to ask for what was missed


def test_a_late_joiner_learns_when_a_message_that_was_kept_was_sent(run: Run) -> None:
    def publish(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("talker")
        publisher = node.create_publisher(Int32, "x", LATCHED)
        node.create_timer(0.5, lambda: publisher.publish(Int32()))
        rclpy.spin(node)

    def hear(found: list[Any]) -> None:
        time.sleep(1.2)
        rclpy.init()
        node = rclpy.create_node("listener")

        def times(message: Any, info: dict[str, int]) -> None:
            ages = [info[each] / 1e9 - 1_800_000_000 for each in ("source_timestamp", "received_timestamp")]
            found.append(tuple(round(age, 2) for age in ages))

        node.create_subscription(Int32, "x", times, LATCHED)
        rclpy.spin(node)

    assert run(publish, hear, seconds=1.7) == [(0.5, 1.2), (1.0, 1.2), (1.5, 1.5)]


def test_what_is_published_before_the_first_spin_is_not_lost(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        one, other = rclpy.create_node("one"), rclpy.create_node("other")
        publisher = one.create_publisher(Int32, "topic", 10)
        other.create_subscription(Int32, "topic", lambda message: found.append(message.data), 10)
        found.append(f"count {publisher.get_subscription_count()}")
        publisher.publish(Int32(data=1))
        rclpy.spin_once(other, timeout_sec=1.0)

    assert run(program) == ["count 1", 1]


def test_what_was_published_before_there_was_a_subscription_is_lost(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        publisher = rclpy.create_node("n").create_publisher(Int32, "topic", 10)
        for number in range(4):
            publisher.publish(Int32(data=number))
            time.sleep(0.4)

    assert run(program, listener(Int32, "topic", 10, delay=0.5)) == [2, 3]


# ---------------------------------------------------------------- queues


def kept_of(run: Run, number: int, qos: Any) -> list[int]:
    """Which of `number` messages, published at once, a subscription still has when it is first spun."""

    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        publisher = node.create_publisher(Int32, "topic", qos)
        node.create_subscription(Int32, "topic", lambda message: found.append(message.data), qos)
        for value in range(number):
            publisher.publish(Int32(data=value))
        time.sleep(0.1)
        rclpy.spin(node)

    return run(program)


def test_a_full_queue_loses_its_oldest_messages(run: Run) -> None:
    assert kept_of(run, 10, 3) == [7, 8, 9]
    assert kept_of(run, 20, qos_profile_sensor_data) == [15, 16, 17, 18, 19]
    assert kept_of(run, 4, 10) == [0, 1, 2, 3]
    assert kept_of(run, 3, 0) == [2]  # a queue has room for one at least


def test_a_queue_that_keeps_all_loses_none(run: Run) -> None:
    assert kept_of(run, 50, QoSProfile(history=HistoryPolicy.KEEP_ALL)) == list(range(50))


def test_a_slow_subscriber_is_always_behind_by_one_queue(run: Run) -> None:
    def fast(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("fast")
        publisher = node.create_publisher(Int32, "topic", 10)
        numbers = iter(range(200))
        timer = node.create_timer(0.01, lambda: tick())

        def tick() -> None:
            number = next(numbers, None)
            if number is None:
                timer.cancel()
            else:
                publisher.publish(Int32(data=number))

        rclpy.spin(node)

    def slow(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("slow")
        node.create_subscription(Int32, "topic", lambda message: (found.append(message.data), time.sleep(0.05)), 10)
        rclpy.spin(node)

    found = run(slow, fast)
    assert found[:4] == [0, 1, 2, 6]  # recorded: 0 1 2 5 10 15 20
    assert found[-10:] == list(range(190, 200))  # recorded: the same
    assert len(found) == pytest.approx(51, abs=1)  # recorded: 51 of 200


# ---------------------------------------------------------------- types


def test_one_process_cannot_use_a_topic_with_two_types(world: World) -> None:
    rclpy.init()
    node = rclpy.create_node("n")
    first = node.create_publisher(Int32, "qt2", 10)
    expected = (
        "failed to create topic [rt/qt2] because it's already in use in this context with a different message type: it "
        "is std_msgs/msg/Int32, asked for was std_msgs/msg/String"
    )
    with pytest.raises(RCLError) as caught:
        node.create_publisher(String, "qt2", 10)
    assert str(caught.value) == f"Failed to create publisher: {expected}"
    with pytest.raises(RCLError) as caught:
        node.create_subscription(String, "qt2", None, 10)
    assert str(caught.value) == f"Failed to create subscription: {expected}"
    node.destroy_publisher(first)
    assert node.create_publisher(String, "qt2", 10).topic_name == "/qt2"


def test_two_processes_can_and_never_hear_each_other(run: Run) -> None:
    def program(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("n")
        publisher = node.create_publisher(Int32, "qt2", 10)
        time.sleep(1.0)
        publisher.publish(Int32(data=1))
        found.append(f"count {publisher.get_subscription_count()}")
        found.append([types for name, types in node.get_topic_names_and_types() if name == "/qt2"])

    # The recorded list had only the type of its own process; ours has both, so that the mistake can be seen.
    assert run(program, listener(String, "qt2", 10)) == ["count 0", [["std_msgs/msg/Int32", "std_msgs/msg/String"]]]


# ---------------------------------------------------------------- profiles

REST = (
    "lifespan=0 nanoseconds, deadline=0 nanoseconds, liveliness=0, liveliness_lease_duration=0 nanoseconds, "
    "avoid_ros_namespace_conventions=False)"
)


@pytest.mark.parametrize(
    ("profile", "beginning"),
    [
        (qos_profile_system_default, "history=0, depth=0, reliability=0, durability=0"),
        (QoSProfile(depth=10), "history=1, depth=10, reliability=1, durability=2"),
        (qos_profile_sensor_data, "history=1, depth=5, reliability=2, durability=2"),
        (qos_profile_services_default, "history=1, depth=10, reliability=1, durability=2"),
        (qos_profile_parameters, "history=1, depth=1000, reliability=1, durability=2"),
        (QoSPresetProfiles.get_from_short_key("sensor_data"), "history=1, depth=5, reliability=2, durability=2"),
    ],
)
def test_profiles_and_how_they_are_shown(profile: QoSProfile, beginning: str) -> None:
    assert repr(profile) == f"QoSProfile({beginning}, {REST}"


def test_a_number_is_a_queue_length(world: World) -> None:
    rclpy.init()
    publisher = rclpy.create_node("n").create_publisher(Int32, "topic", 10)
    assert publisher.qos_profile == QoSProfile(depth=10)
    assert publisher.qos_profile != QoSProfile(depth=11)


@pytest.mark.parametrize(
    ("policies", "kind", "text"),
    [
        (
            {},
            InvalidQoSProfileException,
            "('Invalid QoSProfile', 'History and/or depth settings are required.')",
        ),
        (
            {"history": HistoryPolicy.KEEP_LAST},
            InvalidQoSProfileException,
            "('Invalid QoSProfile', 'History set to KEEP_LAST without a depth setting.')",
        ),
        ({"depth": -1}, ValueError, "history depth must be greater than or equal to zero"),
        (
            {"depth": 10, "reliability": "best_effort"},
            AssertionError,  # of the real one without a text
            "QoS policy 'reliability' must be of type ReliabilityPolicy, got 'best_effort': "
            "try reliability=ReliabilityPolicy.BEST_EFFORT",
        ),
        (
            {"depth": "10"},
            AssertionError,
            "QoS policy 'depth' must be of type int, got '10'",
        ),
        (
            {"depth": 1, "deadline": 1.0},
            AssertionError,
            "QoS policy 'deadline' must be of type Duration, got 1.0",
        ),
        (
            {"depth": 1, "relibility": 1},
            AssertionError,
            "Invalid arguments passed to constructor: relibility; did you mean 'reliability'?",
        ),
    ],
)
def test_a_profile_that_makes_no_sense_is_refused(policies: dict, kind: type[Exception], text: str) -> None:
    with pytest.raises(kind) as caught:
        QoSProfile(**policies)
    assert str(caught.value) == text


def test_a_misspelled_policy_is_no_new_attribute() -> None:
    profile = QoSProfile(depth=10)
    with pytest.raises(AttributeError, match="has no policy 'reliabilty'"):
        profile.reliabilty = ReliabilityPolicy.BEST_EFFORT
    profile.reliability = ReliabilityPolicy.BEST_EFFORT
    assert profile == BEST_EFFORT
