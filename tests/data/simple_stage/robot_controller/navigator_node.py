#!/usr/bin/env python3
"""Open loop: believes that it starts at (0, 0), drives straight on for as long as the distance takes, and sleeps."""

import math
import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from robot_controller.srv import NavigateTo

SPEED = 0.2


class NavigatorNode(Node):
    def __init__(self):
        super().__init__("navigator")
        self.commands = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_service(NavigateTo, "/navigate_to", self.on_goal)
        self.x = 0.0
        self.y = 0.0
        self.get_logger().info("Navigator node started")

    def on_goal(self, request, response):
        began = time.time()
        distance = math.hypot(request.x - self.x, request.y - self.y)
        command = Twist()
        command.linear.x = SPEED
        until = time.time() + distance / SPEED
        while time.time() < until:
            self.commands.publish(command)
            time.sleep(0.1)
        self.commands.publish(Twist())
        self.x, self.y = request.x, request.y
        response.success = distance < 0.5
        response.time_taken = time.time() - began
        return response


def main():
    rclpy.init()
    node = NavigatorNode()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
