"""`ros2 run demo_nodes_py talker`: says "Hello World" once a second."""

from __future__ import annotations

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


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


def main() -> None:
    """The talker of demo_nodes_py."""
    _talk_until_ctrl_c(0, 'Publishing: "{}"')


def main_of_cpp() -> None:
    """That of demo_nodes_cpp."""
    _talk_until_ctrl_c(1, "Publishing: '{}'")


def _talk_until_ctrl_c(first: int, line: str) -> None:
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Talker(first, line))
