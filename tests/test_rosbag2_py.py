"""Programs that write and read bags themselves, with rosbag2_py."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import rclpy
import rosbag2_py
from fibonacci_action import Run
from geometry_msgs.msg import Point
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_runtime_py.utilities import get_message
from std_msgs.msg import String

from turtle_lesson.ros.bags.bag import open_bag
from turtle_lesson.ros.world import World

START = 1_800_000_000_000_000_000
SECOND = 1_000_000_000
CDR = rosbag2_py.ConverterOptions("cdr", "cdr")


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, world: World) -> None:
    monkeypatch.chdir(tmp_path)


def writer(uri: str = "run", storage_id: str = "mcap") -> rosbag2_py.SequentialWriter:
    writer = rosbag2_py.SequentialWriter()
    writer.open(rosbag2_py.StorageOptions(uri=uri, storage_id=storage_id), CDR)
    return writer


def reader(uri: str = "run", **options: Any) -> rosbag2_py.SequentialReader:
    reader = rosbag2_py.SequentialReader()
    reader.open(rosbag2_py.StorageOptions(uri, **options), rosbag2_py.ConverterOptions("", ""))
    return reader


def write_two_topics(uri: str = "run", storage_id: str = "mcap") -> None:
    bag = writer(uri, storage_id)
    bag.create_topic(rosbag2_py.TopicMetadata(name="/words", type="std_msgs/msg/String", serialization_format="cdr"))
    bag.create_topic(rosbag2_py.TopicMetadata(0, "/points", "geometry_msgs/msg/Point", "cdr"))
    for number in range(4):
        time = START + number * SECOND
        bag.write("/words", serialize_message(String(data=f"word {number}")), time)
        bag.write("/points", serialize_message(Point(x=float(number))), time + 1)
    bag.close()


def topics(bag: rosbag2_py.SequentialReader) -> list[tuple[str, float]]:
    """What is left to be read: topics and times, in s from the start."""
    found = []
    while bag.has_next():
        topic, _, time = bag.read_next()
        found.append((topic, (time - START) // SECOND))
    return found


@pytest.mark.parametrize("storage_id", ["mcap", "sqlite3"])
def test_what_is_written_is_read(storage_id: str) -> None:
    write_two_topics(storage_id=storage_id)
    bag = reader(storage_id=storage_id)
    types = {topic.name: topic.type for topic in bag.get_all_topics_and_types()}
    assert types == {"/words": "std_msgs/msg/String", "/points": "geometry_msgs/msg/Point"}
    read = []
    while bag.has_next():
        topic, data, time = bag.read_next()
        read.append((deserialize_message(data, get_message(types[topic])), time - START))
    assert read[:2] == [(String(data="word 0"), 0), (Point(x=0.0), 1)] and len(read) == 8
    with pytest.raises(RuntimeError, match=r"^Bag is at end\. No next message\.$"):
        bag.read_next()
    assert open_bag("run").message_count == 8


def test_filters_and_times() -> None:
    write_two_topics()
    bag = reader()
    assert bag.has_next()
    bag.set_filter(rosbag2_py.StorageFilter(topics=["/points"]))
    assert topics(bag) == [("/points", second) for second in range(4)]
    bag.seek(START + 3 * SECOND)
    assert topics(bag) == [("/points", 3)]
    bag.reset_filter()
    bag.seek(START + 3 * SECOND)
    assert topics(bag) == [("/words", 3), ("/points", 3)]
    bag.set_filter(rosbag2_py.StorageFilter(topics_regex="/w.*"))
    bag.seek(0)
    assert topics(bag) == [("/words", second) for second in range(4)]
    bag.set_filter(rosbag2_py.StorageFilter(exclude_topics=["/words"], regex_to_exclude="/p.*"))
    bag.seek(0)
    assert topics(bag) == []
    part = reader(start_time_ns=START + SECOND, end_time_ns=START + 2 * SECOND)
    assert topics(part) == [("/words", 1), ("/points", 1), ("/words", 2)]


def test_what_there_is_to_know_of_a_bag() -> None:
    write_two_topics()
    for known in (reader().get_metadata(), rosbag2_py.Info().read_metadata("run", "mcap")):
        assert (known.message_count, known.storage_identifier, known.compression_mode) == (8, "mcap", "")
        assert known.duration.nanoseconds == 3 * SECOND + 1 and known.duration.total_seconds() == 3.0
        assert known.starting_time.nanoseconds == START and known.starting_time.year == 2027
        assert known.relative_file_paths == ["run_0.mcap"] and known.bag_size > 100
        counts = {each.topic_metadata.name: each.message_count for each in known.topics_with_message_count}
        assert counts == {"/words": 4, "/points": 4}
    assert rosbag2_py.get_registered_readers() == rosbag2_py.get_registered_writers() == {"mcap", "sqlite3"}


def test_a_node_that_records_completes_its_bag_when_its_program_ends(run: Run, world: World) -> None:
    def recorder(found: list[Any]) -> None:
        rclpy.init()
        node, bag = rclpy.create_node("recorder"), writer()
        bag.create_topic(
            rosbag2_py.TopicMetadata(id=0, name="chat", type="std_msgs/msg/String", serialization_format="")
        )
        now = node.get_clock().now
        node.create_subscription(
            String, "chat", lambda heard: bag.write("chat", heard, now().nanoseconds), 10, raw=True
        )
        rclpy.spin(node)

    def talker(found: list[Any]) -> None:
        rclpy.init()
        node = rclpy.create_node("talker")
        publisher = node.create_publisher(String, "chat", 10)
        node.create_timer(1.0, lambda: publisher.publish(String(data="hi")))
        rclpy.spin(node)

    run(recorder, talker, seconds=3.5)
    world.sim.call_later(0, world.processes[0].interrupt)
    world.sim.run_until(world.now + SECOND)
    known = open_bag("run")
    assert known.message_count == 3 and not known.damage


def test_what_does_not_go_is_said() -> None:
    with pytest.raises(RuntimeError, match="Bag path 'nope' does not exist"):
        reader("nope")
    write_two_topics()
    with pytest.raises(RuntimeError, match=r"^Bag directory already exists \(run\), can't overwrite existing bag$"):
        writer()
    with pytest.raises(
        RuntimeError, match=r"'mcap', not as 'sqlite3': open it with storage_id='mcap', or .* -s sqlite3"
    ):
        reader(storage_id="sqlite3")
    with pytest.raises(RuntimeError, match="mcap or sqlite3, got 'disk'"):
        writer("other", "disk")
    with pytest.raises(RuntimeError, match="Call open"):
        rosbag2_py.SequentialReader().has_next()
    bag = writer("other")
    with pytest.raises(
        RuntimeError, match=r"^Failed to write on topic 'x'\. Call create_topic\(\) before first write\.$"
    ):
        bag.write("x", b"", START)
    with pytest.raises(RuntimeError, match=r"the topic x cannot be written: .*nowhere"):
        bag.create_topic(rosbag2_py.TopicMetadata(name="x", type="nowhere/msg/X", serialization_format="cdr"))
    bag.create_topic(rosbag2_py.TopicMetadata(name="x", type="std_msgs/msg/String", serialization_format="cdr"))
    with pytest.raises(TypeError, match=r"serialize_message\(msg\)"):
        bag.write("x", String(), START)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"now\(\)\.nanoseconds"):
        bag.write("x", b"", 1.5)  # type: ignore[arg-type]
    bag.close()
    with pytest.raises(RuntimeError, match="Call open"):
        bag.write("x", b"", START)
    with pytest.raises(TypeError, match="serialization_format is missing"):
        rosbag2_py.TopicMetadata(name="x", type="std_msgs/msg/String")
    with pytest.raises(NotImplementedError, match="`ros2 bag record` does it"):
        rosbag2_py.Recorder  # noqa: B018
    with pytest.raises(AttributeError, match="no attribute 'Recoder'"):
        rosbag2_py.Recoder  # noqa: B018
