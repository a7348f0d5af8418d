"""`ros2 run demo_nodes_py add_two_ints_server`: a service that adds."""

from __future__ import annotations

from contextlib import suppress

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Adder(Node):
    """Offers `add_two_ints`."""

    def __init__(self) -> None:
        super().__init__("add_two_ints_server")
        self.create_service(AddTwoInts, "add_two_ints", self._add)

    def _add(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        self.get_logger().info(f"Incoming request\na: {request.a} b: {request.b}")
        response.sum = request.a + request.b
        return response


def main() -> None:
    """Answer until Ctrl-C."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Adder())
