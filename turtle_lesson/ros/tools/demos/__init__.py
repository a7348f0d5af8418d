"""`ros2 run demo_nodes_py talker`, `listener`, `add_two_ints_server` and its clients: the programs of ROS 2's first tutorials.

What is C++ on a robot (demo_nodes_cpp) is Python here; topics, texts and pauses are the same (demos, demo_nodes_py and
demo_nodes_cpp of Humble). Each program is plain rclpy.
"""

from __future__ import annotations

from functools import partial

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node
from rclpy.qos import QoSProfile, qos_profile_sensor_data
from std_msgs.msg import String

from .. import spin


class Talker(Node):
    """Publishes on `chatter`, counting; `line` is what it logs of each message."""

    def __init__(self, first: int, line: str) -> None:
        super().__init__("talker")
        self._number, self._line = first, line
        self._publisher = self.create_publisher(String, "chatter", 10)
        self.create_timer(1.0, self._talk)

    def _talk(self) -> None:
        message = String(data=f"Hello World: {self._number}")
        self._number += 1
        self.get_logger().info(self._line.format(message.data))
        self._publisher.publish(message)


def talker(first: int, line: str) -> None:
    """`talker` of both packages: publishes "Hello World" once a second, until Ctrl-C."""
    spin(lambda: Talker(first, line))


def listener(qos: QoSProfile | int = 10) -> None:
    """`listener` of both packages: logs what is published on `chatter`, until Ctrl-C."""

    def make() -> Node:
        node = rclpy.create_node("listener")
        node.create_subscription(String, "chatter", lambda said: node.get_logger().info(f"I heard: [{said.data}]"), qos)
        return node

    spin(make)


listener_best_effort = partial(listener, qos_profile_sensor_data)


class Adder(Node):
    """Offers `add_two_ints`."""

    def __init__(self) -> None:
        super().__init__("add_two_ints_server")
        self.create_service(AddTwoInts, "add_two_ints", self._add)

    def _add(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        self.get_logger().info(f"Incoming request\na: {request.a} b: {request.b}")
        response.sum = request.a + request.b
        return response


add_two_ints_server = partial(spin, Adder)


def add_two_ints_client() -> None:
    """`add_two_ints_client` and `…_client_async`: asks for 2 + 3 once a server is there, logs the answer, and ends."""
    rclpy.init()
    node = rclpy.create_node("add_two_ints_client")
    client = node.create_client(AddTwoInts, "add_two_ints")
    while not client.wait_for_service(timeout_sec=1.0):
        print("service not available, waiting again...")
    future = client.call_async(AddTwoInts.Request(a=2, b=3))
    rclpy.spin_until_future_complete(node, future)
    node.get_logger().info(f"Result of add_two_ints: {future.result().sum}")
