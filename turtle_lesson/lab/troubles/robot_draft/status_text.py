"""Reports the battery on /robot/status, in words."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class StatusText(Node):
    """Publishes ten times a second."""

    def __init__(self) -> None:
        super().__init__("status_monitor")
        self.battery = 100.0
        self.status = self.create_publisher(String, "/robot/status", 10)
        self.create_timer(0.1, self.on_timer)

    def on_timer(self) -> None:
        """Publish the battery's charge."""
        self.status.publish(String(data=f"battery {self.battery:.1f} %"))
        self.battery = max(0.0, self.battery - 0.1)


def main() -> None:
    """Run the node until it is interrupted."""
    rclpy.init()
    try:
        rclpy.spin(StatusText())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
