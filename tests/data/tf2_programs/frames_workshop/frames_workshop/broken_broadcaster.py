"""Forgets w: a quaternion of zeros is no turn at all."""

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from tf2_ros import Buffer, TransformBroadcaster, TransformListener


def main():
    rclpy.init()
    node = Node("broken_broadcaster")
    buffer = Buffer()
    listener = TransformListener(buffer, node)
    broadcaster = TransformBroadcaster(node)
    frame = TransformStamped(child_frame_id="robot")
    frame.header.frame_id = "world"
    frame.transform.rotation.w = 0.0
    broadcaster.sendTransform(frame)
    rclpy.spin_once(node, timeout_sec=1.0)
    print(buffer.can_transform("world", "robot", rclpy.time.Time(), return_debug_tuple=True))
    listener.unregister()
    rclpy.shutdown()
