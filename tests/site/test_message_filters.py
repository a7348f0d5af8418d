"""message_filters: messages that belong together, and a history of them."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from typing import Any

import pytest
import rclpy
from builtin_interfaces.msg import Time as Stamp
from hypothesis import given
from hypothesis import strategies as st
from message_filters import ApproximateTimeSynchronizer, Cache, SimpleFilter, Subscriber, TimeSynchronizer
from rclpy.time import Time
from sensor_msgs.msg import Image
from std_msgs.msg import Header, String

from turtle_lesson.ros.runtime.world import World

Run = Callable[..., list[Any]]


def image(milliseconds: int, frame: str = "") -> Image:
    """A picture of a time."""
    stamp = Stamp(sec=milliseconds // 1000, nanosec=milliseconds % 1000 * 1_000_000)
    return Image(header=Header(stamp=stamp, frame_id=frame))


def millis(message: Any) -> int:
    return message.header.stamp.sec * 1000 + message.header.stamp.nanosec // 1_000_000


class Sets(list[tuple[int, ...]]):
    """What a synchroniser calls back with, as times."""

    def __call__(self, *messages: Any) -> None:
        self.append(tuple(map(millis, messages)))


def test_messages_of_the_same_time(world: World) -> None:
    left, right, found = SimpleFilter(), SimpleFilter(), Sets()
    TimeSynchronizer([left, right], 10).registerCallback(found)
    for source, time in ((left, 1), (left, 2), (right, 2), (right, 1), (right, 3)):
        source.signalMessage(image(time))
    assert found == [(2, 2), (1, 1)]


def test_what_waits_too_long_is_forgotten(world: World) -> None:
    left, right, found = SimpleFilter(), SimpleFilter(), Sets()
    TimeSynchronizer([left, right], 2).registerCallback(found)
    for time in (1, 2, 3):
        left.signalMessage(image(time))
    for time in (1, 2, 3):
        right.signalMessage(image(time))
    assert found == [(2, 2), (3, 3)]


def test_messages_of_nearly_the_same_time(world: World) -> None:
    """The nearest are taken first; a difference as great as the slop is too much."""
    left, right, found = SimpleFilter(), SimpleFilter(), Sets()
    ApproximateTimeSynchronizer([left, right], 10, 0.1).registerCallback(found)
    for time in (0, 150):
        left.signalMessage(image(time))
    for time in (100, 120, 260):
        right.signalMessage(image(time))
    assert found == [(150, 100)]


@given(st.lists(st.tuples(st.integers(0, 2), st.integers(0, 1000)), max_size=40), st.integers(1, 200))
def test_what_is_put_together_lies_within_the_slop_and_is_used_once(arrivals: list[tuple[int, int]], slop: int) -> None:
    sources, found = [SimpleFilter() for _ in range(3)], Sets()
    ApproximateTimeSynchronizer(sources, 5, slop / 1000).registerCallback(found)
    for source, time in arrivals:
        sources[source].signalMessage(image(time))
    for times in found:
        assert max(times) - min(times) < slop
    for source in range(3):
        given_times = sorted(time for each, time in arrivals if each == source)
        used = [times[source] for times in found]
        assert all(used.count(time) <= given_times.count(time) for time in used)


def test_messages_without_header(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    found: list[Any] = []
    texts, others = SimpleFilter(), SimpleFilter()
    ApproximateTimeSynchronizer([texts, others], 10, 0.1).registerCallback(lambda *both: found.append(both))
    texts.signalMessage(String(data="a"))
    assert "a String has no header with a stamp" in "".join(capsys.readouterr())
    allowed = ApproximateTimeSynchronizer([texts, others], 10, 0.1, allow_headerless=True)
    allowed.registerCallback(lambda a, b: found.append(a.data + b.data))
    texts.signalMessage(String(data="a"))
    others.signalMessage(String(data="b"))
    assert found == ["ab"]


def test_a_history(world: World) -> None:
    source = SimpleFilter()
    cache = Cache(source, 3)
    assert (cache.getLast(), cache.getOldestTime(), cache.getElemAfterTime(Time())) == (None, None, None)
    for time in (1, 2, 3, 4):
        source.signalMessage(image(time * 1000))

    def at(seconds: float) -> Time:
        return Time(nanoseconds=round(seconds * 1e9), clock_type=rclpy.clock.ClockType.ROS_TIME)

    assert list(map(millis, cache.getInterval(at(2), at(3)))) == [2000, 3000]
    assert millis(cache.getElemAfterTime(at(2.5))) == 3000
    assert millis(cache.getElemBeforeTime(at(2.5))) == 2000
    assert (cache.getOldestTime(), cache.getLastestTime()) == (at(2), at(4))
    assert millis(cache.getLast()) == 4000
    assert list(map(millis, cache.cache_msgs[-2:])) == [3000, 4000]


def test_subscriptions(run: Run) -> None:
    def listen(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("listener")
        subscribers = [Subscriber(node, Image, name, qos_profile=5) for name in ("left", "right")]
        both = TimeSynchronizer(subscribers, 10)
        both.registerCallback(lambda left, right, more: found.append((millis(left), right.header.frame_id, more)), "!")
        assert copy(subscribers[0]).getTopic() == "left"
        assert subscribers[0].topic_name == "/left" or subscribers[0].topic_name == "left"
        rclpy.spin(node)

    def talk(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("talker")
        publishers = [node.create_publisher(Image, name, 5) for name in ("left", "right")]
        for time in (7, 8):
            for publisher in publishers:
                publisher.publish(image(time, publisher.topic_name))

    (first, second) = run(listen, talk)
    assert (first[0], second[0], first[2]) == (7, 8, "!") and "right" in first[1]


def test_mistakes(world: World) -> None:
    rclpy.init()
    node = rclpy.create_node("n")
    with pytest.raises(TypeError, match="takes 4 positional arguments but 5 were given"):
        Subscriber(node, Image, "left", 10)  # type: ignore[misc]
    with pytest.raises(TypeError, match="a node is expected, got the class Image"):
        Subscriber(Image, "left", 10)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="a callback is expected, got None"):
        SimpleFilter().registerCallback(None)  # type: ignore[arg-type]
