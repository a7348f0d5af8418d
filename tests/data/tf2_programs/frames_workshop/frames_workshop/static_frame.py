"""Tells once where a frame is: its name and its pose (x y z roll pitch yaw) are words of the command line."""

import sys

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster
from tf_transformations import quaternion_from_euler


class StaticFrame(Node):
    def __init__(self, words):
        super().__init__("static_frame")
        self.broadcaster = StaticTransformBroadcaster(self)
        name, numbers = words[1], [float(word) for word in words[2:8]]
        frame = TransformStamped()
        frame.header.stamp = self.get_clock().now().to_msg()
        frame.header.frame_id = "world"
        frame.child_frame_id = name
        shift = frame.transform.translation
        shift.x, shift.y, shift.z = numbers[:3]
        turn = frame.transform.rotation
        turn.x, turn.y, turn.z, turn.w = quaternion_from_euler(*numbers[3:])
        self.broadcaster.sendTransform(frame)


def main():
    words = rclpy.utilities.remove_ros_args(sys.argv)
    if len(words) != 8:
        print("static_frame NAME x y z roll pitch yaw")
        sys.exit(1)
    rclpy.init()
    node = StaticFrame(words)
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
