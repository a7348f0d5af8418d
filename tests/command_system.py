"""The programs that ran beside the recorded commands, as stand-ins: the lesson's three nodes and some more."""

from __future__ import annotations

import time
from array import array
from collections.abc import Callable
from typing import Any

import rclpy
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node

from turtle_lesson.ros.runtime.world import World

Program = Callable[[], None]


def start(world: World, *programs: Program, seconds: float = 0.5) -> None:
    """Start programs and let them run a little."""
    for program in programs:
        world.spawn(program, name=program.__name__)
    world.sim.run_until(world.now + round(seconds * 1e9))


def _spin(make: Callable[[], Node]) -> None:
    rclpy.init(args=[])
    rclpy.spin(make())


def navigator() -> None:
    """A service that takes a second for every new goal, and a publisher of velocities."""
    from geometry_msgs.msg import Twist
    from robot_controller.srv import NavigateTo

    def make() -> Node:
        node = rclpy.create_node("navigator")
        publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        last: list[Any] = []

        def navigate(request: Any, response: Any) -> Any:
            begun = time.time()
            goal = (request.x, request.y)
            if goal not in last:
                for _ in range(round(10 * max(goal, key=abs)) or 10):
                    publisher.publish(Twist())
                    time.sleep(0.1)
            last[:] = [goal]
            response.success, response.time_taken = True, time.time() - begun
            return response

        node.create_service(NavigateTo, "/navigate_to", navigate)
        return node

    _spin(make)


def status_monitor(name: str = "status_monitor") -> None:
    """Reports ten times a second."""
    from robot_controller.msg import TurtleStatus

    def make() -> Node:
        node = rclpy.create_node(name)
        publisher = node.create_publisher(TurtleStatus, "/robot/status", 10)
        status = TurtleStatus(battery=90.0)

        def report() -> None:
            status.battery = max(0.0, status.battery - 0.1)
            publisher.publish(status)

        node.create_timer(0.1, report)
        return node

    _spin(make)


def obstacle_detector() -> None:
    """Scans five times a second."""
    from sensor_msgs.msg import LaserScan

    def make() -> Node:
        node = rclpy.create_node("obstacle_detector")
        publisher = node.create_publisher(LaserScan, "/obstacles", 10)
        scan = LaserScan(angle_min=-1.5708, angle_max=1.5708, angle_increment=0.0174, range_max=10.0)
        scan.header.frame_id = "base_link"
        scan.ranges = array("f", [10.0, 0.5, *[10.0] * 178])

        def publish() -> None:
            scan.header.stamp = node.get_clock().now().to_msg()
            publisher.publish(scan)

        node.create_timer(0.2, publish)
        return node

    _spin(make)


LESSON = (navigator, status_monitor, obstacle_detector)


def param_demo() -> None:
    """Parameters of all kinds."""

    def make() -> Node:
        node = rclpy.create_node("param_demo")
        limits = FloatingPointRange(from_value=0.0, to_value=2.0)
        about = ParameterDescriptor(description="Forward speed in m/s", floating_point_range=[limits])
        node.declare_parameter("speed", 0.5, about)
        node.declare_parameter("name", "turtle")
        node.declare_parameter("count", 3)
        node.declare_parameter("fixed", 7, ParameterDescriptor(read_only=True))
        node.declare_parameter("flags", [True, False])
        node.declare_parameter("gains", [1.0, 2.5, 3.0])

        def check(parameters: Any) -> SetParametersResult:
            too_many = any(each.name == "count" and each.value > 10 for each in parameters)
            return SetParametersResult(successful=not too_many, reason="count must be at most 10" if too_many else "")

        node.add_on_set_parameters_callback(check)
        return node

    _spin(make)


def talker() -> None:
    """Says hello on /chatter twice a second."""
    from std_msgs.msg import String

    def make() -> Node:
        node = rclpy.create_node("talker")
        publisher = node.create_publisher(String, "chatter", 10)
        count = 0

        def talk() -> None:
            nonlocal count
            publisher.publish(String(data=f"Hello World: {count}"))
            node.get_logger().info(f'Publishing: "Hello World: {count}"')
            count += 1

        node.create_timer(0.5, talk)
        return node

    _spin(make)


def formats() -> dict[str, Any]:
    """Messages that are told apart by how they are printed, by name."""
    from geometry_msgs.msg import Point32, Polygon, Pose, PoseArray
    from sensor_msgs.msg import BatteryState, Image, Imu, JointState
    from std_msgs.msg import Bool, Byte, Char, Empty, Float32, Float64, Header, Int32, String, UInt8MultiArray

    return {
        "s_plain": String(data="hello"),
        "s_empty": String(),
        "s_quote": String(data='it\'s "quoted": yes'),
        "s_newline": String(data="two\nlines"),
        "s_uni": String(data="é 😀"),
        "s_num": String(data="5"),
        "s_true": String(data="true"),
        "s_long": String(data="x" * 200),
        "s_colon": String(data="a: b"),
        "s_hash": String(data="# c"),
        "s_words": String(data="word " * 60),
        "b": Bool(data=True),
        "f32": Float32(data=0.1),
        "f64": Float64(data=0.1),
        "f64e": Float64(data=1e-7),
        "f64big": Float64(data=1e20),
        "nan": Float64(data=float("nan")),
        "inf": Float64(data=-float("inf")),
        "int": Int32(data=-5),
        "byte": Byte(data=b"\x05"),
        "char": Char(data=65),
        "empty": Empty(),
        "joint": JointState(name=["a", "b"], position=[1.0, 2.0]),
        "joint0": JointState(),
        "image": Image(height=2, width=2, encoding="mono8", step=2, data=[1, 2, 3, 4]),
        "imu": Imu(),
        "posearray": PoseArray(poses=[Pose(), Pose()]),
        "u8": UInt8MultiArray(data=[1, 2, 255]),
        "poly": Polygon(points=[Point32(x=1.0)]),
        "battery": BatteryState(present=True, cell_voltage=[float("nan"), 3.7]),
        "header": Header(frame_id="map"),
    }


def publish_formats() -> None:
    """Publishes each of `formats()` five times a second, on `/f/<name>`."""

    def make() -> Node:
        node = rclpy.create_node("formats")
        pairs = [(node.create_publisher(type(each), f"/f/{name}", 10), each) for name, each in formats().items()]

        def publish() -> None:
            for publisher, message in pairs:
                publisher.publish(message)

        node.create_timer(0.2, publish)
        return node

    _spin(make)
