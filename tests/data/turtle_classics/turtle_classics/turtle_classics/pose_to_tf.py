"""Tells on /tf where the turtles are that it is given as words."""

import functools
import math
import sys

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from tf2_ros import TransformBroadcaster
from turtlesim.msg import Pose


class PoseToTf(Node):
    def __init__(self, turtles):
        super().__init__("pose_to_tf")
        self.broadcaster = TransformBroadcaster(self)
        for turtle in turtles:
            self.create_subscription(Pose, f"{turtle}/pose", functools.partial(self.tell, turtle), 10)

    def tell(self, turtle, pose):
        message = TransformStamped(child_frame_id=turtle)
        message.header.frame_id = "world"
        message.header.stamp = self.get_clock().now().to_msg()
        message.transform.translation.x, message.transform.translation.y = pose.x, pose.y
        message.transform.rotation.z = math.sin(pose.theta / 2)
        message.transform.rotation.w = math.cos(pose.theta / 2)
        self.broadcaster.sendTransform(message)


def main():
    with rclpy.init():
        rclpy.spin(PoseToTf(rclpy.utilities.remove_ros_args(sys.argv)[1:]))
