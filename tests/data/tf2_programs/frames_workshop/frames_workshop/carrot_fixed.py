"""Tells ten times a second of a frame that stays two metres to the left of turtle1."""

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from tf2_ros import TransformBroadcaster


class CarrotFixed(Node):
    def __init__(self):
        super().__init__("carrot_fixed")
        self.broadcaster = TransformBroadcaster(self)
        self.create_timer(0.1, self.on_timer)

    def on_timer(self):
        frame = TransformStamped()
        frame.header.stamp = self.get_clock().now().to_msg()
        frame.header.frame_id = "turtle1"
        frame.child_frame_id = "carrot1"
        frame.transform.translation.y = 2.0
        self.broadcaster.sendTransform(frame)


def main():
    rclpy.init()
    try:
        rclpy.spin(CarrotFixed())
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
