"""`ros2 run demo_nodes_py add_two_ints_client_async`: asks for 2 + 3, and hears the answer in a callback."""

from __future__ import annotations

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.task import Future


def main() -> None:
    """Ask, log the answer when it comes, and end."""
    rclpy.init()
    node = rclpy.create_node("add_two_ints_client")
    client = node.create_client(AddTwoInts, "add_two_ints")
    while not client.wait_for_service(timeout_sec=1.0):
        print("service not available, waiting again...")
    answered = Future()

    def hear(future: Future) -> None:
        node.get_logger().info(f"Result of add_two_ints: {future.result().sum}")
        answered.set_result(True)

    client.call_async(AddTwoInts.Request(a=2, b=3)).add_done_callback(hear)
    rclpy.spin_until_future_complete(node, answered)
