"""A laser scanner as they are sold: five scans a second, sent with best effort, a wall half a metre ahead."""

import math

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan

BEAMS = 181


class Laser(Node):
    """Publishes /obstacles."""

    def __init__(self) -> None:
        super().__init__("laser")
        self.scans = self.create_publisher(LaserScan, "/obstacles", qos_profile_sensor_data)
        self.create_timer(0.2, self.on_timer)

    def on_timer(self) -> None:
        """Publish one scan."""
        scan = LaserScan(angle_min=-math.pi / 2, angle_max=math.pi / 2, angle_increment=math.pi / (BEAMS - 1))
        scan.range_max = 10.0
        scan.ranges = [0.5 if abs(beam - BEAMS // 2) < 5 else 10.0 for beam in range(BEAMS)]
        self.scans.publish(scan)


def main() -> None:
    """Run the node until it is interrupted."""
    rclpy.init()
    try:
        rclpy.spin(Laser())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
