"""Rings the alarm: publishes on /alarm how near the nearest obstacle is, for each scan in which one is near."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


class ObstacleAlarm(Node):
    """Hears /obstacles with the reliability that its parameter of this name says."""

    def __init__(self) -> None:
        super().__init__("obstacle_alarm")
        reliability = self.declare_parameter("reliability", "reliable").value
        quality = QoSProfile(depth=10, reliability=ReliabilityPolicy[reliability.upper()])
        self.alarm = self.create_publisher(Float32, "/alarm", 10)
        self.create_subscription(LaserScan, "/obstacles", self.on_scan, quality)

    def on_scan(self, scan: LaserScan) -> None:
        """Ring if something is nearer than a metre."""
        nearest = min(scan.ranges)
        if nearest < 1.0:
            self.alarm.publish(Float32(data=nearest))


def main() -> None:
    """Run the node until it is interrupted."""
    rclpy.init()
    try:
        rclpy.spin(ObstacleAlarm())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
