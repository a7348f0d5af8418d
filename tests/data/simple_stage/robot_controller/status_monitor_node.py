#!/usr/bin/env python3
"""Reports a position that nothing ever updates."""

import rclpy
from rclpy.node import Node
from robot_controller.msg import TurtleStatus


class StatusMonitorNode(Node):
    def __init__(self):
        super().__init__("status_monitor")
        self.statuses = self.create_publisher(TurtleStatus, "/robot/status", 10)
        self.create_timer(0.1, self.on_timer)
        self.battery = 100.0

    def on_timer(self):
        self.statuses.publish(TurtleStatus(battery=self.battery))
        self.battery = max(0.0, self.battery - 0.1)


def main():
    rclpy.init()
    node = StatusMonitorNode()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
