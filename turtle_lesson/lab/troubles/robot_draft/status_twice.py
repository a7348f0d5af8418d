"""Reports the turtle's state on /robot/status, ten times a second."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from robot_controller.msg import TurtleStatus
from turtlesim.msg import Pose


class StatusMonitor(Node):
    """Keeps the newest pose and reports it."""

    def __init__(self) -> None:
        super().__init__("status_monitor")
        self.battery = 100.0
        self.pose = Pose()
        self.status = self.create_publisher(TurtleStatus, "/robot/status", 10)
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)
        self.create_timer(0.1, self.on_timer)
        self.start_reporting()

    def start_reporting(self) -> None:
        """Have the status published from now on."""
        self.create_timer(0.1, self.on_timer)

    def on_pose(self, pose: Pose) -> None:
        """Keep the newest pose."""
        self.pose = pose

    def on_timer(self) -> None:
        """Publish one status."""
        pose = self.pose
        self.status.publish(TurtleStatus(x=pose.x, y=pose.y, theta=pose.theta, battery=self.battery))
        self.battery = max(0.0, self.battery - 0.1)


def main() -> None:
    """Run the node until it is interrupted."""
    rclpy.init()
    try:
        rclpy.spin(StatusMonitor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
