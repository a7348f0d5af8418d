"""Says where points are, seen from the world, that are told in another frame."""

import rclpy
import tf2_geometry_msgs  # noqa: F401
from geometry_msgs.msg import PointStamped
from rclpy.duration import Duration
from rclpy.node import Node
from tf2_ros import Buffer, TransformException, TransformListener


class PointTransformer(Node):
    def __init__(self):
        super().__init__("point_transformer")
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self, spin_thread=True)
        self.create_subscription(PointStamped, "points", self.on_point, 10)

    def on_point(self, point):
        try:
            there = self.buffer.transform(point, "world", Duration(seconds=0.2)).point
        except TransformException as error:
            self.get_logger().warning(str(error))
            return
        self.get_logger().info(f"{there.x:.2f} {there.y:.2f} {there.z:.2f}")


def main():
    rclpy.init()
    node = PointTransformer()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
