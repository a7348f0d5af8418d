"""Drives to the corner that the planner has named last."""

import math

import rclpy
from geometry_msgs.msg import Point, Twist
from rclpy.node import Node
from turtlesim.msg import Pose

from patrol.planner import LATEST

SPEED = 1.5
TURN = 3.0


def command(x, y, theta, corner, gain):
    """How fast to drive (m/s) and to turn (rad/s) towards a corner: a plain function, which a test needs no robot for."""
    error = math.remainder(math.atan2(corner[1] - y, corner[0] - x) - theta, math.tau)
    turn = max(-TURN, min(TURN, gain * error))
    return SPEED * max(0.0, math.cos(error)), turn


class Driver(Node):
    """Publishes a command ten times a second."""

    def __init__(self):
        super().__init__("driver")
        self.gain = self.declare_parameter("gain", 4.0).value
        self.corner = self.pose = None
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_subscription(Point, "/patrol/corner", self.on_corner, LATEST)
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)
        self.create_timer(0.1, self.on_timer)

    def on_corner(self, corner):
        """There is a new corner."""
        self.corner = (corner.x, corner.y)

    def on_pose(self, pose):
        """The robot is there now."""
        self.pose = (pose.x, pose.y, pose.theta)

    def on_timer(self):
        """Drive on, once it is known where it is and where it should go."""
        if self.pose is None or self.corner is None:
            return
        speed, turn = command(*self.pose, self.corner, self.gain)
        twist = Twist()
        twist.linear.x, twist.angular.z = speed, turn
        self.publisher.publish(twist)


def main():
    """Run the node."""
    rclpy.init()
    rclpy.spin(Driver())


if __name__ == "__main__":
    main()
