"""Says which corner is next, and counts those that were reached."""

import math

import rclpy
from geometry_msgs.msg import Point
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Int32
from turtlesim.msg import Pose

CORNERS = [(3.0, 3.0), (8.0, 3.0), (8.0, 8.0), (3.0, 8.0)]
NEAR = 0.3

LATEST = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""A node that comes up later gets the latest message, too: nodes come up in any order."""


class Planner(Node):
    """Publishes the next corner when the robot is near the one before."""

    def __init__(self):
        super().__init__("planner")
        self.reached = 0
        self.corner_publisher = self.create_publisher(Point, "/patrol/corner", LATEST)
        self.reached_publisher = self.create_publisher(Int32, "/patrol/reached", LATEST)
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)
        self.publish()

    @property
    def corner(self):
        """The next corner, x and y in metres."""
        return CORNERS[self.reached % len(CORNERS)]

    def on_pose(self, pose):
        """Go on to the next corner if this one is reached."""
        if math.dist(self.corner, (pose.x, pose.y)) < NEAR:
            self.reached += 1
            self.publish()

    def publish(self):
        """Tell everybody."""
        x, y = self.corner
        self.corner_publisher.publish(Point(x=x, y=y))
        self.reached_publisher.publish(Int32(data=self.reached))


def main():
    """Run the node."""
    rclpy.init()
    rclpy.spin(Planner())


if __name__ == "__main__":
    main()
