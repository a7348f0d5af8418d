"""Recording: a bag holds what was published, in a form that other programs read."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import rclpy
from bag_help import no_package_is_left, plain, write_bag  # noqa: F401
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Int32, String

from turtle_lesson import start
from turtle_lesson.ros.bags import BagError
from turtle_lesson.ros.bags.recorder import Recording
from turtle_lesson.ros.bags.writer import schema_text, type_hash
from turtle_lesson.ros.idl.registry import registry
from turtle_lesson.ros.runtime.world import World

Heard = dict[str, list[tuple[int, Any]]]
TOPICS = {
    "/turtle1/pose": "turtlesim/msg/Pose",
    "/turtle1/cmd_vel": "geometry_msgs/msg/Twist",
    "/robot/status": "robot_controller/msg/TurtleStatus",
    "/obstacles": "sensor_msgs/msg/LaserScan",
    "/parameter_events": "rcl_interfaces/msg/ParameterEvent",
    "/rosout": "rcl_interfaces/msg/Log",
}


def listen(world: World) -> Heard:
    """Have an ordinary node hear what the recorder should hear: time and values of every message, by topic."""
    heard: Heard = {topic: [] for topic in TOPICS}

    def main() -> None:
        rclpy.init()
        node = rclpy.create_node("witness", start_parameter_services=False, enable_rosout=False)
        for topic, type_name in TOPICS.items():
            latched = DurabilityPolicy.TRANSIENT_LOCAL if topic == "/rosout" else DurabilityPolicy.VOLATILE

            def hear(message: Any, info: Any, topic: str = topic) -> None:
                heard[topic].append((info["source_timestamp"], plain(message)))

            node.create_subscription(
                registry.get(type_name), topic, _two(hear), QoSProfile(depth=500, durability=latched)
            )
        rclpy.spin(node)

    world.spawn(main, name="witness")
    return heard


def _two(hear: Callable[..., None]) -> Callable[[Any, Any], None]:
    return lambda message, info: hear(message, info)


@pytest.fixture(scope="module", params=["mcap", "sqlite3"])
def whole_run(request: Any, tmp_path_factory: Any) -> tuple[Path, Heard]:
    """A whole run of the lesson's system, recorded from before it was launched: the bag, and what a witness heard."""
    folder = tmp_path_factory.mktemp("bags") / f"run_{request.param}"
    lesson = start()
    recording = lesson.record(folder, storage=request.param)
    heard = listen(lesson._world)
    lesson.launch("robot_controller", "start_system.launch.py")
    lesson.run(1)

    def drive() -> None:
        from robot_controller.srv import NavigateTo

        rclpy.init()
        node = rclpy.create_node("caller")
        client = node.create_client(NavigateTo, "navigate_to")
        rclpy.spin_until_future_complete(node, client.call_async(NavigateTo.Request(x=7.0, y=7.0)))

    lesson._world.spawn(drive, name="caller")
    lesson.run(15)
    recording.stop()
    lesson.run(1)
    return folder, {topic: [entry for entry in found if entry[0] < END] for topic, found in heard.items()}


def without_witness(found: Heard) -> Heard:
    """What the witness said of itself, before it could hear."""
    events = found["/parameter_events"]
    return found | {"/parameter_events": [entry for entry in events if entry[1]["node"] != "/witness"]}


END = 1_800_000_000_000_000_000 + 16_900_000_000  # when the recording stopped: the launch itself takes 0.9 s


def test_a_whole_run_is_read_back_by_rosbags_with_nothing_but_the_bag(whole_run: tuple[Path, Heard]) -> None:
    from rosbags.rosbag2 import Reader
    from rosbags.typesys import get_types_from_msg
    from rosbags.typesys.store import Typestore

    folder, heard = whole_run
    found: Heard = {topic: [] for topic in TOPICS}
    with Reader(folder) as reader:
        store = Typestore()
        for connection in reader.connections:
            store.register(get_types_from_msg(connection.msgdef.data, connection.msgtype))
        for connection, moment, data in reader.messages(reader.connections):
            if connection.topic in found:
                found[connection.topic].append((moment, plain(store.deserialize_cdr(data, connection.msgtype))))
        assert all(connection.digest.startswith("RIHS01_") for connection in reader.connections)
        if folder.name.endswith("mcap"):
            assert reader.topics["/robot/status"].msgdef.data.startswith("# ")
    assert min(len(messages) for messages in found.values()) > 2
    assert without_witness(found) == heard


def test_a_whole_run_is_read_back_by_mcap(whole_run: tuple[Path, Heard]) -> None:
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    folder, heard = whole_run
    if folder.name.endswith("sqlite3"):
        pytest.skip("the other storage")
    found: Heard = {topic: [] for topic in TOPICS}
    with (folder / f"{folder.name}_0.mcap").open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()], validate_crcs=True)
        for _, channel, message, decoded in reader.iter_decoded_messages():
            if channel.topic in found:
                found[channel.topic].append((message.log_time, plain(decoded)))
    assert without_witness(found) == heard


def test_no_gap_at_the_beginning(world: World, tmp_path: Path) -> None:
    """What a program publishes in the moment after it made its publisher is in the bag, too."""

    def talker() -> None:
        rclpy.init()
        node = rclpy.create_node("talker")
        publisher = node.create_publisher(Int32, "count", 10)
        for number in range(1000):
            publisher.publish(Int32(data=number))

    with Recording(world, tmp_path / "b", ["/count"]) as recording:
        world.spawn(talker, name="talker")
        world.sim.run_until(world.now + 1_000_000)
    assert recording.message_count == 1000


@pytest.mark.parametrize("ending", ["stop", "seconds", "new world"])
def test_no_gap_at_the_end(tmp_path: Path, ending: str) -> None:
    """What was published before the end, and is under way when it comes, is in the bag."""
    from turtle_lesson.ros.bags.bag import open_bag
    from turtle_lesson.ros.bags.recorder import Selection, record
    from turtle_lesson.ros.bags.writer import BagWriter
    from turtle_lesson.ros.runtime.world import open_world

    world = open_world()
    times = [0, 999_899_000, 999_990_000, 999_999_999, 1_000_000_000, 1_000_000_001]

    def talker() -> None:
        rclpy.init()
        node = rclpy.create_node("talker")
        publisher = node.create_publisher(Int32, "count", 10)
        for number, moment in enumerate(times):
            world.sim.sleep_until(moment)
            publisher.publish(Int32(data=number))

    if ending == "seconds":
        world.spawn(lambda: record(BagWriter(tmp_path / "b"), Selection(("/count",)), lambda *_: None, 1.0), name="r")
        world.spawn(talker, name="talker")
        world.sim.run_until(2_000_000_000)
    else:
        recording = Recording(world, tmp_path / "b", ["/count"])
        world.spawn(talker, name="talker")
        world.sim.run_until(1_000_000_000)
        before = world.now
        if ending == "stop":
            recording.stop()
            assert world.now == before
            world.sim.run_until(2_000_000_000)
        else:
            open_world()
    messages = list(open_bag(tmp_path / "b").messages())
    assert [message.time - 1_800_000_000_000_000_000 for message in messages] == times[: len(messages)]
    assert len(messages) == 4 or (
        ending == "seconds" and len(messages) == 5
    )  # at the same instant, either may be first


def test_a_topic_that_appears_later_and_one_that_nobody_publishes(world: World, tmp_path: Path) -> None:
    from turtle_lesson.ros.bags.bag import open_bag

    def listener() -> None:
        rclpy.init()
        node = rclpy.create_node("listener")
        node.create_subscription(String, "silence", lambda _: None, 10)
        rclpy.spin(node)

    world.spawn(listener, name="listener")
    with Recording(world, tmp_path / "b"):
        world.sim.run_until(1_000_000_000)
        world.spawn(talk("late", String, 10, String(data="x")), name="late")
        world.sim.run_until(2_000_000_000)
    counts = {topic.name: topic.count for topic in open_bag(tmp_path / "b").topics}
    assert counts["/late"] == 1
    assert "/silence" not in counts


# ---------------------------------------------------------------- what is told about topics


def talk(topic: str, kind: Any, profile: Any, message: Any = None) -> Callable[[], None]:
    def main() -> None:
        rclpy.init()
        node = rclpy.create_node("talker")
        publisher = node.create_publisher(kind, topic, profile)
        publisher.publish(message or kind())
        rclpy.spin(node)

    return main


def test_latched_messages_of_before_are_recorded_and_the_quality_of_service_is_noted(
    world: World, tmp_path: Path
) -> None:
    from turtle_lesson.ros.bags.bag import open_bag

    latched = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    weak = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    world.spawn(talk("map", String, latched, String(data="here")), name="a")
    world.spawn(talk("noise", String, weak), name="b")
    world.sim.run_until(1_000_000_000)
    with Recording(world, tmp_path / "b"):
        world.sim.run_until(2_000_000_000)
    bag = open_bag(tmp_path / "b")
    topics = {topic.name: topic for topic in bag.topics}
    assert topics["/map"].count == 1
    assert bag.start == 1_800_000_001_000_000_000, "it came when it was asked for, not before the bag began"
    (profile,) = topics["/map"].profiles
    assert (profile.durability.name, profile.depth) == ("TRANSIENT_LOCAL", 3)
    (profile,) = topics["/noise"].profiles
    assert (profile.reliability.name, profile.depth) == ("BEST_EFFORT", 5)
    assert (profile.deadline.sec, profile.deadline.nsec) == (9_223_372_036, 854_775_807)


def test_the_recorder_is_hidden_and_leaves_nothing_behind(world: World, tmp_path: Path) -> None:
    world.spawn(talk("t", String, 10), name="a")
    recording = Recording(world, tmp_path / "b")
    assert [node.full_name for node in world.graph.nodes if not node.hidden] == ["/talker"]
    recording.stop()
    recording.stop()
    assert [node.full_name for node in world.graph.nodes] == ["/talker"]
    assert world.graph.on_change == []
    assert repr(recording).endswith("messages, done>")


def test_types_that_no_bag_can_hold_are_told_and_the_rest_is_recorded(world: World, tmp_path: Path) -> None:
    from example_interfaces.msg import WString

    recording = Recording(world, tmp_path / "b", ["/wide", "/good"])
    world.spawn(talk("wide", WString, 10), name="a")
    world.spawn(talk("good", String, 10), name="b")
    with pytest.warns(UserWarning, match=r"example_interfaces/msg/WString cannot be recorded \(it has a wstring\)"):
        world.sim.run_until(1_000_000_000)
    recording.stop()
    assert recording.message_count == 1


def test_a_topic_with_two_types_is_left_out(world: World, tmp_path: Path) -> None:
    world.spawn(talk("t", String, 10), name="a")
    world.spawn(talk("t", Int32, 10), name="b")
    world.sim.settle()
    with pytest.warns(UserWarning, match="Topic '/t' has more than one type associated"):
        Recording(world, tmp_path / "b", ["/t"]).stop()


def test_a_topic_that_nobody_published_is_told_at_the_end(world: World, tmp_path: Path) -> None:
    world.spawn(talk("chatter", String, 10), name="a")
    with (
        pytest.warns(UserWarning, match="no node published on /chater .* Did you mean '/chatter'"),
        Recording(world, tmp_path / "b", ["/chater"]),
    ):
        world.sim.run_until(1_000_000_000)


# ---------------------------------------------------------------- beginning and end


def test_nothing_is_ever_overwritten(world: World, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("precious")
    write_bag(tmp_path / "bag")
    before = (tmp_path / "bag" / "bag_0.mcap").read_bytes()
    for name in ("file", "bag"):
        with pytest.raises(BagError, match=rf"^Output folder '.*{name}' already exists\."):
            Recording(world, tmp_path / name)
    assert (tmp_path / "file").read_text() == "precious"
    assert (tmp_path / "bag" / "bag_0.mcap").read_bytes() == before


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        ({"storage": "zip"}, "stored as mcap or sqlite3"),
        ({"topics": []}, "names no topic"),
        ({"topics": ["a b"]}, "Invalid topic name"),
        ({"topics": "/pose"}, r'topics=\["/pose"\]'),
        ({"topics": [3]}, "the name of a topic is a text"),
        ({"path": "x\0y"}, "cannot be (called|written)"),
    ],
)
def test_wrong_arguments_are_refused_before_anything_is_made(
    world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: dict[str, Any], error: str
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(Exception, match=error):
        Recording(world, **{"path": "bag", **arguments})
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_new_world_completes_the_bag_of_the_old_one(tmp_path: Path, storage: str) -> None:
    from turtle_lesson.ros.bags.bag import open_bag

    lesson = start()
    lesson.record(tmp_path / "b", storage=storage)
    lesson.run(1)
    start(simulator=False)
    bag = open_bag(tmp_path / "b")
    assert not bag.damage
    assert bag.message_count > 100


def test_an_empty_bag_is_a_bag(world: World, tmp_path: Path) -> None:
    from turtle_lesson.ros.bags.bag import open_bag

    Recording(world, tmp_path / "b").stop()
    bag = open_bag(tmp_path / "b")
    assert (bag.message_count, bag.damage, list(bag.messages())) == (0, "", [])


def test_virtual_time_goes_on_as_if_nobody_recorded(tmp_path: Path) -> None:
    def run(record: bool) -> list[tuple[float, float]]:
        lesson = start()
        if record:
            lesson.record(tmp_path / "b")
        poses: list[tuple[float, float]] = []

        def watch() -> None:
            from turtlesim.msg import Pose

            rclpy.init()
            node = rclpy.create_node("watch")
            node.create_subscription(Pose, "/turtle1/pose", lambda pose: poses.append((time.time(), pose.x)), 10)
            rclpy.spin(node)

        lesson._world.spawn(watch, name="watch")
        lesson.run(2)
        return poses

    assert run(True) == run(False)


# ---------------------------------------------------------------- definitions


def test_hashes_are_those_of_a_real_ros() -> None:
    """The hashes that `ros2 topic info -v` of Iron and newer shows for these types."""
    from geometry_msgs.msg import Twist

    real = {
        String: "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
        Twist: "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a",
    }
    assert {kind: type_hash(kind, schema_text(kind)) for kind in real} == real


def test_a_definition_comes_with_all_that_it_is_made_of() -> None:
    from geometry_msgs.msg import PoseStamped

    text = schema_text(PoseStamped)
    heads = [line for line in text.splitlines() if line.startswith("MSG: ")]
    names = ["std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/Pose"]
    assert heads == [f"MSG: {name}" for name in [*names, "geometry_msgs/Point", "geometry_msgs/Quaternion"]]
    assert text.count("=" * 80 + "\n") == 5


def test_a_learners_definitions_go_into_the_bag_as_written(world: World, tmp_path: Path) -> None:
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    folder = tmp_path / "mine"
    (folder / "msg").mkdir(parents=True)
    (folder / "msg" / "Leg.msg").write_bytes(b"# a leg\r\nfloat32 length 0.5  # m\r\nbyte flags\r\n")
    (folder / "msg" / "Robot.msg").write_text(
        "int32 LEGS=4\nstring<=10 name 'anna'\nLeg[4] legs\nLeg[<=2] spare\nbool[] bits\nchar c\nstring[] words\n"
    )
    registry.add("mine", folder)
    try:
        Robot, Leg = registry.get("mine/msg/Robot"), registry.get("mine/msg/Leg")
        robot = Robot(spare=[Leg(length=0.25, flags=b"\x07")], bits=[True, False], c=65, words=["a", "µ"])
        with Recording(world, tmp_path / "b", ["/robot"]):
            world.spawn(talk("robot", Robot, 10, robot), name="a")
            world.sim.run_until(1_000_000_000)
    finally:
        registry.remove("mine")
    with (tmp_path / "b" / "b_0.mcap").open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        ((schema, _, _, found),) = reader.iter_decoded_messages()
    assert schema is not None
    assert schema.encoding == "ros2msg"
    assert b"MSG: mine/Leg\n# a leg\nfloat32 length 0.5  # m\n" in schema.data
    assert (found.name, found.bits, found.c, found.words) == ("anna", [True, False], 65, ["a", "µ"])
    assert [leg.length for leg in found.legs] == [0.5] * 4
    assert (found.spare[0].length, found.spare[0].flags) == (0.25, 7)
