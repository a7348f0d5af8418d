"""`lesson.network`: a page makes the network bad, and the tools show it as they would on a robot."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy
from command_cases import type_in
from hypothesis import given
from hypothesis import strategies as st
from rclpy.qos import QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from sensor_msgs.msg import LaserScan

import turtle_lesson
from turtle_lesson import Lesson
from turtle_lesson.ros.bags import bag as bags
from turtle_lesson.ros.rmw.network import Conditions, checked_name, conditions
from turtle_lesson.ros.runtime.world import current_world
from turtle_lesson.ros.sim.simulation import EPOCH

SECOND = 1_000_000_000


@pytest.fixture
def lesson() -> Iterator[Lesson]:
    """A lesson in which a scanner publishes on /scan, ten times a second, as scanners do: best effort."""
    lesson = turtle_lesson.start(package=None, simulator=False)
    current_world().spawn(_scanner, name="scanner")
    lesson.run(1.0)
    yield lesson
    current_world().close()


def _scanner() -> None:
    rclpy.init()
    node = rclpy.create_node("scanner")
    publisher = node.create_publisher(LaserScan, "/scan", qos_profile_sensor_data)

    def scan() -> None:
        message = LaserScan()
        message.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(message)

    node.create_timer(0.1, scan)
    rclpy.spin(node)


def typed(command: str) -> str:
    """What a command prints."""
    return type_in(current_world(), command).stdout


# ---------------------------------------------------------------- what the tools show


def test_hz_shows_what_is_lost(lesson: Lesson) -> None:
    lesson.network("/scan", loss=0.4)
    rates = [float(rate) for rate in re.findall(r"average rate: ([\d.]+)", typed("ros2 topic hz /scan --for 20"))]
    assert 5 < rates[-1] < 7
    lesson.network("/scan")
    rates = re.findall(r"average rate: ([\d.]+)", typed("ros2 topic hz /scan --for 5"))
    assert rates[-1] == "10.000"


def test_delay_shows_how_long_it_takes(lesson: Lesson) -> None:
    lesson.network("/scan", latency=0.2, jitter=0.1)
    shown = typed("ros2 topic delay /scan --for 10").splitlines()
    assert re.match(r"average delay: 0\.2[3-7]", shown[-2])
    assert "min: 0.20" in shown[-1] and "max: 0." in shown[-1]


def test_echo_says_what_was_lost_unless_it_is_told_not_to(lesson: Lesson) -> None:
    lesson.network("/scan", loss=0.5)
    shown = typed("ros2 topic echo /scan --field header.stamp.sec --for 3")
    assert "A message was lost!!!\n\ttotal count change:1\n\ttotal count: 1---\n" in shown
    assert "lost" not in typed("ros2 topic echo /scan --field header.stamp.sec --no-lost-messages --for 3")


def test_echo_asks_for_what_its_options_say(lesson: Lesson) -> None:
    def talk() -> None:
        rclpy.init()
        node = rclpy.create_node("talker")
        reliable = node.create_publisher(LaserScan, "/sure", 100)
        node.create_timer(0.1, lambda: reliable.publish(LaserScan()))
        rclpy.spin(node)

    current_world().spawn(talk, name="talker")
    lesson.run(1.0)
    lesson.network("/sure", loss=0.5)
    for options, least, most in (
        ("", 98, 100),
        (" --qos-reliability reliable", 98, 100),
        (" --qos-reliability best_effort", 35, 65),
    ):
        shown = typed(f"ros2 topic echo /sure --field header.stamp.sec --for 10{options}")
        assert least <= re.sub(r"A message was lost!!!\n.*\n.*---\n", "", shown).count("---") <= most


def test_a_bag_has_what_arrived_and_when(lesson: Lesson, tmp_path: Path) -> None:
    lesson.network("/scan", latency=0.3, loss=0.5)
    with lesson.record(tmp_path / "run", ["/scan"]):
        lesson.run(10.0)
    messages = list(bags.open_bag(tmp_path / "run").messages())
    assert 35 < len(messages) < 65
    stamps = [(message.time, _stamp(message.data)) for message in messages]
    assert all(logged - stamp >= 0.299 * SECOND for logged, stamp in stamps[:-5])
    assert stamps[0][0] >= EPOCH + 1.0 * SECOND


def _stamp(data: bytes) -> int:
    from rclpy.serialization import deserialize_message

    stamp = deserialize_message(data, LaserScan).header.stamp
    return stamp.sec * SECOND + stamp.nanosec


# ---------------------------------------------------------------- what may be said


def test_rules_are_shown_changed_and_forgotten(lesson: Lesson) -> None:
    assert lesson.network() == {}
    lesson.network("/turtle*/pose", latency=0.2)
    rules = lesson.network("/scan", latency=0.2, jitter=0.05, loss=0.3)
    assert repr(rules) == "{'/scan': <0.2 s to 0.25 s under way, 30 % lost>, '/turtle*/pose': <0.2 s under way>}"
    assert lesson.network("/scan", loss=0) == {
        "/scan": Conditions(),  # as usual, whatever patterns say
        "/turtle*/pose": conditions(latency=0.2),
    }
    assert list(lesson.network("/scan")) == ["/turtle*/pose"]
    assert lesson.network(None) == lesson.network() == {}


def test_a_topic_need_not_be_there_yet(lesson: Lesson) -> None:
    lesson.network("/later*", loss=1)
    rclpy.init()
    node = rclpy.create_node("n")
    heard: list[Any] = []
    hasty = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    node.create_subscription(LaserScan, "/later/scan", heard.append, hasty)
    node.create_publisher(LaserScan, "/later/scan", 5).publish(LaserScan())
    lesson.spin(1.0)
    assert heard == []


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"topic": "/scan", "loss": 30}, "loss must be a share from 0 to 1, got 30: for 30 % write loss=0.3"),
        ({"topic": "/scan", "loss": -0.1}, "loss must be a share from 0 to 1, got -0.1: try loss=0.3"),
        ({"topic": "/scan", "latency": "0.2"}, "latency must be a number of seconds from 0 to 3600, got '0.2'"),
        ({"topic": "/scan", "latency": float("nan")}, "latency must be a number of seconds from 0 to 3600, got nan"),
        ({"topic": "/scan", "jitter": True}, "jitter must be a number of seconds from 0 to 3600, got True"),
        ({"topic": "scan", "loss": 0.1}, "the full name of a topic begins with a slash, got 'scan': try '/scan'"),
        ({"topic": "/my scan", "loss": 0.1}, "'/my scan' cannot be a topic: topic name must not contain characters"),
        ({"topic": 5, "loss": 0.1}, "the name of a topic is a text such as '/scan'"),
        ({"loss": 0.1}, "name the topic of these conditions"),
    ],
)
def test_what_cannot_be_is_refused(lesson: Lesson, arguments: dict[str, Any], text: str) -> None:
    with pytest.raises((ValueError, TypeError), match=re.escape(text)):
        lesson.network(**arguments)
    assert lesson.network() == {}


@given(value=st.one_of(st.none(), st.floats(), st.integers(), st.text(), st.booleans()))
def test_no_number_breaks_anything(value: Any) -> None:
    for name in ("latency", "jitter", "loss"):
        try:
            found = conditions(**{name: value})
        except ValueError as error:
            assert str(error).startswith(f"{name} must be")
        else:
            assert 0 <= getattr(found, name) <= 3600 * SECOND


@given(name=st.text(alphabet="/*?[]{}~ab1_ .é", max_size=12))
def test_no_name_breaks_anything(name: str) -> None:
    from turtle_lesson.ros.rmw.network import Network

    try:
        network = Network()
        network.set(checked_name(name), Conditions())
        network.of("/a/b")
    except ValueError as error:
        assert str(error)
