"""Asks where turtle1 was five seconds ago, seen from where turtle2 is now."""

import rclpy
from rclpy.duration import Duration
from rclpy.node import Node
from tf2_ros import Buffer, TransformException, TransformListener


class LateFollower(Node):
    def __init__(self):
        super().__init__("late_follower")
        self.declare_parameter("timeout", 0.05)
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self, spin_thread=False)
        self.create_timer(1.0, self.on_timer)

    def on_timer(self):
        now = self.get_clock().now()
        past = now - Duration(seconds=5.0)
        timeout = Duration(seconds=self.get_parameter("timeout").value)
        try:
            seen = self.buffer.lookup_transform_full(
                target_frame="turtle2",
                target_time=rclpy.time.Time(),
                source_frame="turtle1",
                source_time=past,
                fixed_frame="world",
                timeout=timeout,
            )
        except TransformException as error:
            self.get_logger().info(f"{type(error).__name__}: {error}")
            return
        there = seen.transform.translation
        self.get_logger().info(f"five seconds ago turtle1 was at {there.x:.2f} {there.y:.2f}")


def main():
    rclpy.init()
    try:
        rclpy.spin(LateFollower())
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
