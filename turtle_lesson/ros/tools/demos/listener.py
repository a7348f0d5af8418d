"""`ros2 run demo_nodes_py listener`: logs what is said on `chatter`."""

from __future__ import annotations

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String


def main() -> None:
    """Listen until Ctrl-C."""
    rclpy.init()
    node = rclpy.create_node("listener")
    node.create_subscription(String, "chatter", lambda said: node.get_logger().info(f"I heard: [{said.data}]"), 10)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)
