"""`ros2 run demo_nodes_py listener`: logs what is said on `chatter`."""

from __future__ import annotations

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.qos import QoSProfile, qos_profile_sensor_data
from std_msgs.msg import String


def main() -> None:
    """The listener of both packages."""
    _listen_until_ctrl_c(QoSProfile(depth=10))


def main_of_best_effort() -> None:
    """`ros2 run demo_nodes_cpp listener_best_effort`: a message that is lost is not sent to it again."""
    _listen_until_ctrl_c(qos_profile_sensor_data)


def _listen_until_ctrl_c(qos: QoSProfile) -> None:
    rclpy.init()
    node = rclpy.create_node("listener")
    node.create_subscription(String, "chatter", lambda said: node.get_logger().info(f"I heard: [{said.data}]"), qos)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)
