"""Tells where a turtle is, seen from the world, each time that its pose comes."""

import math

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from tf2_ros import TransformBroadcaster
from turtlesim.msg import Pose


class TurtleBroadcaster(Node):
    def __init__(self):
        super().__init__("turtle_broadcaster")
        self.turtle = self.declare_parameter("turtlename", "turtle1").get_parameter_value().string_value
        self.broadcaster = TransformBroadcaster(self)
        self.create_subscription(Pose, f"/{self.turtle}/pose", self.on_pose, 1)

    def on_pose(self, pose):
        frame = TransformStamped()
        frame.header.stamp = self.get_clock().now().to_msg()
        frame.header.frame_id = "world"
        frame.child_frame_id = self.turtle
        frame.transform.translation.x = pose.x
        frame.transform.translation.y = pose.y
        frame.transform.rotation.z = math.sin(pose.theta / 2.0)
        frame.transform.rotation.w = math.cos(pose.theta / 2.0)
        self.broadcaster.sendTransform(frame)


def main():
    rclpy.init()
    try:
        rclpy.spin(TurtleBroadcaster())
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
