"""A spiral: the turning stays the same and the speed grows, until the wall is near."""

import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose


class Spiral(Node):
    def __init__(self):
        super().__init__("spiral")
        self.declare_parameters("", [("turn", 2.0), ("growth", 0.2), ("margin", 1.0)])
        self.twist = Twist()
        self.twist.angular.z = self.get_parameter("turn").value
        self.publisher = self.create_publisher(Twist, "turtle1/cmd_vel", 10)
        self.create_subscription(Pose, "turtle1/pose", self.on_pose, 10)
        self.create_timer(0.1, self.on_timer)

    def on_timer(self):
        self.twist.linear.x += 0.1 * self.get_parameter("growth").value
        self.publisher.publish(self.twist)

    def on_pose(self, pose):
        margin = self.get_parameter("margin").value
        if not (margin < pose.x < 11.0 - margin and margin < pose.y < 11.0 - margin):
            self.publisher.publish(Twist())
            self.get_logger().info(f"near the wall at a speed of {self.twist.linear.x:.1f}")
            raise SystemExit(0)


def main():
    rclpy.init(args=sys.argv)
    node = Spiral()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
