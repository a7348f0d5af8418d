"""`ros2 run turtlesim mimic --ros-args -r input/pose:=turtle1/pose -r output/cmd_vel:=turtle2/cmd_vel`.

One turtle does what another one does. Plain ``rclpy``. Facts: ros_tutorials, turtlesim/tutorials/mimic.cpp.
"""

from __future__ import annotations

from contextlib import suppress

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.msg import Pose


class Mimic(Node):
    """Passes the speeds of a pose on as a command."""

    def __init__(self) -> None:
        super().__init__("turtle_mimic")
        self._publisher = self.create_publisher(Twist, "output/cmd_vel", 1)
        self.create_subscription(Pose, "input/pose", self._on_pose, 1)

    def _on_pose(self, pose: Pose) -> None:
        message = Twist()
        message.linear.x, message.angular.z = pose.linear_velocity, pose.angular_velocity
        self._publisher.publish(message)


def main() -> None:
    """Run until Ctrl-C."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Mimic())
