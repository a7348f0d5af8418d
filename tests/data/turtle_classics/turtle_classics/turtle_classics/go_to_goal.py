"""P control to a goal that is given on the command line or by parameters: `go_to_goal 2.0 9.0`."""

import math
import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from turtlesim.msg import Pose


class GoToGoal(Node):
    def __init__(self, words):
        super().__init__("go_to_goal")
        self.declare_parameter("x", 8.0)
        self.declare_parameter("y", 8.0)
        self.declare_parameter("tolerance", 0.1)
        self.goal = [float(word) for word in words] or [self.get_parameter(name).value for name in "xy"]
        self.done = rclpy.task.Future()
        self.pose = Pose()
        self.subscription = self.create_subscription(Pose, "/turtle1/pose", self.update_pose, 10)
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.timer = self.create_timer(0.05, self.step)

    def update_pose(self, pose):
        self.pose = pose
        self.pose.x = round(self.pose.x, 4)
        self.pose.y = round(self.pose.y, 4)

    def euclidean_distance(self):
        return math.sqrt((self.goal[0] - self.pose.x) ** 2 + (self.goal[1] - self.pose.y) ** 2)

    def steering(self):
        heading = math.atan2(self.goal[1] - self.pose.y, self.goal[0] - self.pose.x)
        return math.remainder(heading - self.pose.theta, 2.0 * math.pi)

    def step(self):
        command = Twist()
        if self.euclidean_distance() >= self.get_parameter("tolerance").value:
            command.linear.x = 1.5 * self.euclidean_distance()
            command.angular.z = 6.0 * self.steering()
        elif not self.done.done():
            self.done.set_result((self.pose.x, self.pose.y))
        self.publisher.publish(command)


def main(args=None):
    rclpy.init(args=args)
    node = GoToGoal(remove_ros_args(sys.argv)[1:])
    rclpy.spin_until_future_complete(node, node.done, timeout_sec=30.0)
    if node.done.done():
        node.get_logger().info("arrived at {:.1f} {:.1f}".format(*node.done.result()))
    else:
        node.get_logger().error("gave up")
    node.destroy_node()
    rclpy.shutdown()
    return 0 if node.done.done() else 1
