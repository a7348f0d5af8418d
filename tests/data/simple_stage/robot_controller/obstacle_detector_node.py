#!/usr/bin/env python3
"""Makes readings up, and one too few of them."""

import random

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class ObstacleDetectorNode(Node):
    def __init__(self):
        super().__init__("obstacle_detector")
        self.scans = self.create_publisher(LaserScan, "/obstacles", 10)
        self.create_timer(0.2, self.on_timer)

    def on_timer(self):
        scan = LaserScan(angle_min=-1.5708, angle_max=1.5708, angle_increment=0.0174, range_max=10.0)
        scan.header.stamp = self.get_clock().now().to_msg()
        scan.header.frame_id = "base_link"
        readings = int((scan.angle_max - scan.angle_min) / scan.angle_increment)
        scan.ranges = [0.5 if random.random() > 0.95 else 10.0 for _ in range(readings)]
        self.scans.publish(scan)


def main():
    rclpy.init()
    node = ObstacleDetectorNode()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
