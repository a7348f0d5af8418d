"""`ros2 run demo_nodes_py add_two_ints_client`: asks for 2 + 3, once somebody can answer."""

from __future__ import annotations

import rclpy
from example_interfaces.srv import AddTwoInts


def main() -> None:
    """Ask, log the answer, and end."""
    rclpy.init()
    node = rclpy.create_node("add_two_ints_client")
    client = node.create_client(AddTwoInts, "add_two_ints")
    while not client.wait_for_service(timeout_sec=1.0):
        print("service not available, waiting again...")
    future = client.call_async(AddTwoInts.Request(a=2, b=3))
    rclpy.spin_until_future_complete(node, future)
    node.get_logger().info(f"Result of add_two_ints: {future.result().sum}")
