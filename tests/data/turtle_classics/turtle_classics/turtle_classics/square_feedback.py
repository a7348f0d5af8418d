"""The corners of a square one after the other, with an eye on the pose, at a Rate in a thread beside the spinning."""

import math
import threading

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.msg import Pose


class SquareFeedback(Node):
    def __init__(self):
        super().__init__("square_feedback")
        self.side = self.declare_parameter("side", 3.0).value
        self.pose = None
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)

    def on_pose(self, pose):
        self.pose = pose

    def walk(self):
        rate = self.create_rate(50)
        while self.pose is None:
            rate.sleep()
        x, y = self.pose.x, self.pose.y
        corners = [(x + self.side, y), (x + self.side, y + self.side), (x, y + self.side), (x, y)]
        for corner in corners:
            while not self.step_towards(*corner):
                rate.sleep()
            self.get_logger().info(f"at {self.pose.x:.1f} {self.pose.y:.1f}")
        self.publisher.publish(Twist())

    def step_towards(self, x, y):
        away = math.hypot(x - self.pose.x, y - self.pose.y)
        turn = math.remainder(math.atan2(y - self.pose.y, x - self.pose.x) - self.pose.theta, 2.0 * math.pi)
        command = Twist()
        if away < 0.05:
            self.publisher.publish(command)
            return True
        command.angular.z = 4.0 * turn
        command.linear.x = min(2.0, 1.5 * away) if abs(turn) < 0.1 else 0.0
        self.publisher.publish(command)
        return False


def main(args=None):
    rclpy.init(args=args)
    node = SquareFeedback()
    spinning = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
    spinning.start()
    try:
        node.walk()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
