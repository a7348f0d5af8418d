"""The recorder in a running world: it hears everything from the first message on, and nobody sees it."""

import importlib.util
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from turtle_lesson.lab.path import plot_path
from turtle_lesson.lab.recorder import Recorder
from turtle_lesson.lab.status_and_scan import plot_scan, plot_status
from turtle_lesson.ros.idl.registry import registry
from turtle_lesson.ros.runtime.world import World, open_world
from turtle_lesson.ros.sim.simulation import EPOCH
from turtle_lesson.turtlesim.obstacles import Box, Circle

# isort: split
# Importing turtle_lesson made these packages importable.
import rclpy
from geometry_msgs.msg import Twist, Vector3
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String
from turtlesim.msg import Pose
from visualization_msgs.msg import Marker, MarkerArray

SECOND = 1_000_000_000
STATUS_FIELDS = "float32 x\nfloat32 y\nfloat32 theta\nfloat32 vel_x\nfloat32 vel_y\nfloat32 battery\n"


class Bench:
    """A world with a recorder in it. Programs of a test come and go beside it."""

    def __init__(self) -> None:
        self.world: World = open_world()
        self.recorder: Any = None
        self.world.spawn(self._lab, name="lab")
        self.world.sim.settle()
        rclpy.init()
        self.eye: Node = rclpy.create_node("eye")

    def _lab(self) -> None:
        rclpy.init()
        node = rclpy.create_node("_lab", start_parameter_services=False, enable_rosout=False)
        self.recorder = Recorder(node, origin=EPOCH)
        rclpy.spin(node)

    def run(self, seconds: float) -> None:
        self.world.sim.run_until(self.world.now + round(seconds * SECOND))

    def start(self, name: str, build: Callable[[Node], Any]) -> Any:
        """Start a program whose node has what `build` puts into it."""

        def program() -> None:
            rclpy.init()
            node = rclpy.create_node(name)
            node.kept = build(node)
            rclpy.spin(node)

        return self.world.spawn(program, name=name)

    def publish(self, kind: type, topic: str, message: Any, period: float = 0.1) -> Any:
        """Start a program that publishes a message at a rate."""

        def build(node: Node) -> None:
            publisher = node.create_publisher(kind, topic, 10)
            node.create_timer(period, lambda: publisher.publish(message))

        return self.start("talker" + topic.replace("/", "_"), build)

    def topics(self) -> list[str]:
        own = {"/rosout", "/parameter_events"}
        return [name for name, _ in self.eye.get_topic_names_and_types() if name not in own]


@pytest.fixture
def bench() -> Iterator[Bench]:
    yield Bench()
    if "robot_controller" in registry.packages():
        registry.remove("robot_controller")


@pytest.fixture
def package(tmp_path) -> Callable[[str], Any]:
    """Makes robot_controller/msg/TurtleStatus importable, with fields of the test's choice."""

    def make(fields: str) -> Any:
        (tmp_path / "msg").mkdir(exist_ok=True)
        (tmp_path / "msg" / "TurtleStatus.msg").write_text(fields, encoding="utf-8")
        if "robot_controller" in registry.packages():
            registry.remove("robot_controller")
        registry.add("robot_controller", tmp_path)
        return importlib.import_module("robot_controller.msg").TurtleStatus

    return make


def obey(node: Node) -> Any:
    """What a simulator does: listens to commands."""
    return node.create_subscription(Twist, "/turtle1/cmd_vel", lambda _: None, 10)


def test_the_very_first_message_of_a_new_node_is_heard_with_its_time(bench):
    bench.run(0.35)
    bench.publish(Pose, "/turtle1/pose", Pose(x=1.0, y=2.0, theta=0.5, linear_velocity=0.25))
    bench.run(1.05)
    rows = bench.recorder.poses.array()
    assert len(rows) == 10
    assert bench.recorder.seconds(rows["stamp"][[0, -1]]) == pytest.approx([0.45, 1.35])
    assert rows[0].tolist()[1:] == (1.0, 2.0, 0.5, 0.25)


def test_a_publisher_that_comes_late_in_a_nodes_life_is_found_within_a_second(bench):
    def build(node: Node) -> None:
        def late() -> None:
            timer.cancel()
            publisher = node.create_publisher(Pose, "/turtle1/pose", 10)
            node.create_timer(0.5, lambda: publisher.publish(Pose()))

        timer = node.create_timer(2.3, late)

    bench.start("slow", build)
    bench.run(6.0)
    assert len(bench.recorder.poses) >= 6


def test_the_recorder_makes_no_topic_appear(bench):
    bench.run(2.0)
    assert bench.topics() == []
    talker = bench.publish(LaserScan, "/obstacles", LaserScan())
    bench.run(2.05)
    assert bench.topics() == ["/obstacles"] and len(bench.recorder.scans) == 20
    talker.kill()
    bench.run(2.0)
    assert bench.topics() == [] and len(bench.recorder.scans) == 20


def test_a_publisher_that_waits_for_a_simulator_is_not_fooled(bench):
    bench.publish(Twist, "/turtle1/cmd_vel", Twist())
    bench.run(2.0)
    assert bench.eye.count_subscribers("/turtle1/cmd_vel") == 0
    bench.start("turtlesim", obey)
    bench.run(1.05)
    assert len(bench.recorder.commands) == 11


def test_commands_are_recorded_by_their_parts(bench):
    bench.start("turtlesim", obey)
    command = Twist(linear=Vector3(x=0.25, y=-0.5), angular=Vector3(z=2.0))
    bench.publish(Twist, "/turtle1/cmd_vel", command)
    bench.run(0.15)
    assert bench.recorder.commands.array()[0].tolist()[1:] == (0.25, -0.5, 2.0)


def test_two_runs_of_the_same_world_are_told_in_the_same_words():
    def tell() -> str:
        bench = Bench()
        bench.publish(Pose, "/turtle1/pose", Pose(x=3.0, y=4.0))
        bench.run(2.0)
        return plot_path(bench.recorder).text

    assert tell() == tell()
    assert "from 0.10 s to 1.90 s of robot time: it stayed at (3.00, 4.00) m facing 0.00 rad" in tell()


def test_silence_is_explained(bench, package):
    assert plot_path(bench.recorder).text == (
        "No path yet. No node publishes /turtle1/pose. "
        "Is the simulator running? Try start(simulator=True), or: ros2 run turtlesim turtlesim_node"
    )
    assert plot_scan(bench.recorder).text == (
        "No scan yet. No node publishes /obstacles. "
        'Try lesson.launch("robot_controller", "start_system.launch.py"), '
        "or: ros2 run robot_controller obstacle_detector"
    )
    bench.publish(Pose, "/turtle1/pose", Pose(), period=5.0)
    bench.run(0.1)
    assert plot_path(bench.recorder).text == (
        "No path yet. /talker_turtle1_pose can publish /turtle1/pose, but no message has come yet. "
        "Let time pass: lesson.run(1.0)"
    )


def test_another_type_on_the_topic_is_named(bench):
    bench.publish(String, "/robot/status", String(data="fine"))
    bench.run(1.0)
    assert plot_status(bench.recorder).text == (
        "No status yet. /robot/status is published as std_msgs/msg/String, but this plot reads "
        "robot_controller/msg/TurtleStatus: compare the types in ros2 topic info /robot/status --verbose"
    )


def test_a_type_that_cannot_be_imported_yet_is_named_and_heard_once_it_can(bench, package):
    status = package(STATUS_FIELDS)
    registry.remove("robot_controller")
    bench.publish(status, "/robot/status", status(battery=50.0))
    bench.run(1.0)
    assert plot_status(bench.recorder).text == (
        "No status yet. /robot/status is published, but the type robot_controller/msg/TurtleStatus cannot be imported "
        "here: is its package built and sourced? Try colcon build --packages-select robot_controller, then source "
        "install/setup.bash"
    )
    package(STATUS_FIELDS)
    bench.recorder.look()
    bench.run(1.0)
    assert "battery from 50.0 % to 50.0 %" in plot_status(bench.recorder).text


def test_a_rebuilt_message_without_a_battery_is_heard_too(bench, package):
    first = package(STATUS_FIELDS)
    talker = bench.publish(first, "/robot/status", first(battery=50.0))
    bench.run(1.05)
    talker.kill()
    second = package("float32 x\nfloat32 y\nstring theta\n")
    bench.publish(second, "/robot/status", second(x=7.0, theta="east"))
    bench.run(1.05)
    assert len(bench.recorder.statuses) == 20
    assert bench.recorder.statuses.array()["x"].tolist() == [0.0] * 10 + [7.0] * 10
    assert plot_status(bench.recorder).png()


def test_obstacles_are_the_newest_that_were_published_even_before(bench):
    def marker(number: int, kind: int, **details: Any) -> Marker:
        made = Marker(ns="obstacles", id=number, type=kind, **details)
        made.pose.position.x, made.scale.x, made.scale.y = float(number), 0.5, 1.0
        return made

    box, gone = marker(2, Marker.CUBE), marker(1, Marker.CUBE, action=Marker.DELETE)
    box.pose.orientation.z = box.pose.orientation.w = 0.5**0.5
    wipe = Marker(action=Marker.DELETEALL)
    first = [marker(9, Marker.CUBE), wipe, marker(1, Marker.CYLINDER), box]
    then = [marker(3, Marker.SPHERE), marker(4, Marker.TEXT_VIEW_FACING), gone]
    publishers = []

    def build(node: Node) -> None:
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        publishers.append(node.create_publisher(MarkerArray, "/world/obstacles", latched))
        publishers[0].publish(MarkerArray(markers=first))

    bench.start("world", build)
    bench.run(1.0)
    round_one, box_one = bench.recorder.obstacles.values()
    assert round_one == Circle(1.0, 0.0, 0.375)
    assert box_one == Box(2.0, 0.0, 0.5, 1.0, box_one.angle) and box_one.angle == pytest.approx(1.5707963)
    publishers[0].publish(MarkerArray(markers=then))
    bench.run(1.0)
    assert [each.shape for each in bench.recorder.obstacles.values()] == ["box", "circle"]


def test_a_closed_recorder_hears_no_more_but_keeps_what_it_heard(bench):
    bench.publish(Pose, "/turtle1/pose", Pose())
    bench.run(1.05)
    channel = bench.recorder._channels["/turtle1/pose"]
    bench.recorder.close()
    bench.run(1.0)
    assert len(bench.recorder.poses) == 10
    assert not channel.listens
    assert "when the recorder was closed" in bench.recorder.why_silent("/turtle1/pose")
