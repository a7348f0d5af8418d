"""Playing: what was recorded is published again, with the same values, at the same distances, or as it is asked for."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import rclpy
from bag_help import BEGIN, SECOND, write_bag
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Int32, String

from turtle_lesson.ros.bags import BagError
from turtle_lesson.ros.bags.bag import open_bag
from turtle_lesson.ros.bags.player import Playback, parse_remaps, play
from turtle_lesson.ros.bags.recorder import Recording
from turtle_lesson.ros.bags.writer import BagWriter
from turtle_lesson.ros.idl.registry import registry
from turtle_lesson.ros.runtime.world import World

PERIOD = 10_000_000  # of the bag that `write_bag` writes, in ns


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """A bag with a hundred numbers in a second."""
    write_bag(tmp_path / "bag", 100, size=10)
    return tmp_path / "bag"


def play_in(world: World, path: Path, seconds: float | None = None, **how: Any) -> tuple[list[str], list[bool]]:
    """Play a bag in a process of its own; returns what it says, and (once it has ended) whether it came to its end."""
    said: list[str] = []
    ended: list[bool] = []

    def main() -> None:
        ended.append(play(open_bag(path), Playback(**how), lambda severity, text: said.append(text), seconds))

    process = world.spawn(main, name="player")
    world.sim.run_until(world.now + 10 * SECOND)
    if process.error is not None:
        raise process.error
    return said, ended


@pytest.fixture
def numbers(world: World) -> Callable[[str], list[tuple[int, int]]]:
    """Hear numbers on a topic: the list of (time since the start in ns, number) is filled while the world runs."""

    def hear(topic: str) -> list[tuple[int, int]]:
        heard: list[tuple[int, int]] = []

        def main() -> None:
            rclpy.init()
            node = rclpy.create_node("ear")
            node.create_subscription(
                Int32, topic, lambda m, info: heard.append((info["source_timestamp"] - BEGIN, m.data)), 1000
            )
            rclpy.spin(node)

        world.spawn(main, name="ear")
        world.sim.settle()
        return heard

    return hear


Numbers = Callable[[str], list[tuple[int, int]]]


def test_everything_comes_at_its_time(world: World, bag: Path, numbers: Numbers) -> None:
    heard = numbers("/count")
    assert play_in(world, bag) == ([], [True])
    assert heard == [(number * PERIOD, number) for number in range(100)]


def test_at_twice_the_speed_from_half_a_second_on(world: World, bag: Path, numbers: Numbers) -> None:
    heard = numbers("/count")
    play_in(world, bag, rate=2.0, start_offset=0.5)
    assert heard == [((number - 50) * PERIOD // 2, number) for number in range(50, 100)]


def test_under_another_name(world: World, bag: Path, numbers: Numbers) -> None:
    old, new = numbers("/count"), numbers("/robot/count")
    play_in(world, bag, remaps=parse_remaps(["/count:=/robot/count"]))
    assert (len(old), len(new)) == (0, 100)


def test_only_some_topics(world: World, bag: Path, numbers: Numbers) -> None:
    heard = numbers("/count")
    play_in(world, bag, topics=("/chatter",))
    assert heard == []
    play_in(world, bag, topics=("/count",))
    assert [number for _, number in heard] == list(range(100))


def test_again_and_again_until_the_time_is_over(world: World, bag: Path, numbers: Numbers) -> None:
    heard = numbers("/count")
    assert play_in(world, bag, seconds=2.5, loop=True) == ([], [False])
    assert [number for _, number in heard][:205] == [*range(100), *range(100), *range(5)]
    assert heard[-1][0] < 2.5 * SECOND


def test_played_and_recorded_again_it_is_the_same(world: World, bag: Path, tmp_path: Path) -> None:
    with Recording(world, tmp_path / "again", ["/count", "/chatter"], storage="sqlite3"):
        play_in(world, bag)
    assert sorted(open_bag(tmp_path / "again").messages()) == sorted(open_bag(bag).messages())


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_velocities_lead_a_turtle_of_another_world_along_the_same_path(tmp_path: Path, storage: str) -> None:
    from turtle_lesson import start

    def poses(during: Callable[[Any], object]) -> list[tuple[float, float]]:
        lesson = start(package=None)
        found: list[tuple[float, float]] = []

        def watch() -> None:
            from turtlesim.msg import Pose

            rclpy.init()
            node = rclpy.create_node("watch")
            node.create_subscription(Pose, "/turtle1/pose", lambda pose: found.append((pose.x, pose.y)), 10)
            rclpy.spin(node)

        lesson._world.spawn(watch, name="watch")
        during(lesson)
        return found

    def drive() -> None:
        from geometry_msgs.msg import Twist

        rclpy.init()
        publisher = rclpy.create_node("driver").create_publisher(Twist, "/turtle1/cmd_vel", 10)
        for number in range(40):
            message = Twist()
            message.linear.x, message.angular.z = 1.0 + number % 3, 0.5 * (number % 5) - 1.0
            publisher.publish(message)
            time.sleep(0.1)

    def record(lesson: Any) -> None:
        with lesson.record(tmp_path / "b", ["/turtle1/cmd_vel"], storage=storage):
            lesson._world.spawn(drive, name="driver")
            lesson.run(5)

    def replay(lesson: Any) -> None:
        lesson._world.spawn(lambda: play(open_bag(tmp_path / "b"), Playback(), lambda *_: None), name="player")
        lesson.run(5)

    first, again = poses(record), poses(replay)
    assert len({round(x, 2) for x, _ in first}) > 50, "it went somewhere"
    assert again == first


def test_what_was_latched_is_latched_again(world: World, tmp_path: Path) -> None:
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    writer = BagWriter(tmp_path / "b")
    writer.add_topic("/map", String, [latched])
    writer.write("/map", "std_msgs/msg/String", BEGIN, b"\0\1\0\0\2\0\0\0a\0")
    writer.close()

    def main() -> None:
        play(open_bag(tmp_path / "b"), Playback(loop=True), lambda *_: None, 0.5)

    world.spawn(main, name="player")
    world.sim.run_until(SECOND // 10 + 1)
    (writer_end,) = [end for end, _ in world.graph.topic("/map").writers]
    assert writer_end.quality.latched
    assert writer_end.quality.depth == 1


# ---------------------------------------------------------------- what does not go


def test_a_type_that_is_not_here_is_left_out(world: World, tmp_path: Path, numbers: Numbers) -> None:
    from rosbags.rosbag2 import StoragePlugin, Writer

    with Writer(tmp_path / "b", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        strange = writer.add_connection("/strange", "their_msgs/msg/Odd", msgdef="int32 x\n", rihs01="RIHS01_0")
        known = writer.add_connection("/count", "std_msgs/msg/Int32", msgdef="int32 data\n", rihs01="RIHS01_0")
        about = {"msgdef": "int32 data\n", "rihs01": "RIHS01_0", "serialization_format": "json"}
        writer.add_connection("/text", "std_msgs/msg/Int32", **about)
        for number in range(10):
            writer.write(strange, number, b"\0\1\0\0" + bytes(4))
            writer.write(known, number, b"\0\1\0\0" + bytes([number, 0, 0, 0]))
    heard = numbers("/count")
    said, _ = play_in(world, tmp_path / "b")
    first, second = said
    assert first.startswith("Ignoring a topic '/strange', reason: there is no interface package 'their_msgs'")
    assert second == "Ignoring a topic '/text', reason: its messages are not written as CDR but as 'json'"
    assert [number for _, number in heard] == list(range(10))


def test_a_message_that_has_other_fields_today_is_left_out(world: World, tmp_path: Path) -> None:
    (tmp_path / "msg").mkdir()
    definition = tmp_path / "msg" / "Leg.msg"
    definition.write_text("float32 length\n")
    try:
        registry.add("mine", tmp_path)
        writer = BagWriter(tmp_path / "b")
        writer.add_topic("/leg", registry.get("mine/msg/Leg"), [])
        writer.close()
        definition.write_text("float32 length  # in metres\n")
        registry.add("mine", tmp_path)
        assert play_in(world, tmp_path / "b")[0] == [
            "nothing was played: the bag holds 0 messages in 0 s, and none that was requested"
        ]
        definition.write_text("float64 length\n")
        registry.add("mine", tmp_path)
        said, _ = play_in(world, tmp_path / "b")
    finally:
        registry.remove("mine")
    assert said[0].startswith(
        "Ignoring a topic '/leg', reason: the mine/msg/Leg in the bag has other fields than the current one"
    )


def test_spoiled_messages_are_counted(world: World, tmp_path: Path, numbers: Numbers) -> None:
    writer = BagWriter(tmp_path / "b")
    writer.add_topic("/count", Int32, [])
    for number in range(4):
        writer.write("/count", "std_msgs/msg/Int32", BEGIN + number, b"\0\1\0\0" + bytes(4 if number % 2 else 1))
    writer.close()
    heard = numbers("/count")
    assert play_in(world, tmp_path / "b")[0] == ["2 messages of '/count' are damaged and were left out"]
    assert len(heard) == 2


def test_a_damaged_bag_is_played_as_far_as_it_goes(world: World, bag: Path, numbers: Numbers) -> None:
    file = bag / "bag_0.mcap"
    file.write_bytes(file.read_bytes()[:4000])
    heard = numbers("/count")
    play_in(world, bag)
    assert 10 < len(heard) < 90
    assert [number for _, number in heard] == list(range(len(heard)))


def test_behind_the_end_there_is_nothing(world: World, bag: Path) -> None:
    assert play_in(world, bag, start_offset=5.0)[0] == [
        "nothing was played: the bag holds 200 messages in 0.99 s, and none that was requested"
    ]


@pytest.mark.parametrize(
    ("rule", "error"),
    [
        ("a", "is not a remapping: write it as /old_topic:=/new_topic"),
        (":=/b", "not a remapping"),
        ("/a:=/b c", "Invalid topic"),
    ],
)
def test_wrong_remappings(rule: str, error: str) -> None:
    with pytest.raises(Exception, match=error):
        parse_remaps([rule])


def test_a_topic_that_is_not_in_the_bag(world: World, bag: Path) -> None:
    with pytest.raises(BagError, match=r"the bag has no topic '/cout'\. Did you mean '/count'\?"):
        play_in(world, bag, topics=("/cout",))
