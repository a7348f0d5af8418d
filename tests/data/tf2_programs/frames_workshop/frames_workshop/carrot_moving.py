"""Tells ten times a second of a frame that circles around turtle1, once in 2 pi seconds."""

import math

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from tf2_ros import TransformBroadcaster


class CarrotMoving(Node):
    def __init__(self):
        super().__init__("carrot_moving")
        self.broadcaster = TransformBroadcaster(self)
        self.create_timer(0.1, self.on_timer)

    def on_timer(self):
        now = self.get_clock().now()
        seconds, nanoseconds = now.seconds_nanoseconds()
        angle = math.fmod(seconds, 2.0 * math.pi) + nanoseconds / 1e9
        frame = TransformStamped()
        frame.header.stamp = now.to_msg()
        frame.header.frame_id = "turtle1"
        frame.child_frame_id = "carrot1"
        frame.transform.translation.x = 2.0 * math.cos(angle)
        frame.transform.translation.y = 2.0 * math.sin(angle)
        self.broadcaster.sendTransform([frame])


def main():
    rclpy.init()
    try:
        rclpy.spin(CarrotMoving())
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
