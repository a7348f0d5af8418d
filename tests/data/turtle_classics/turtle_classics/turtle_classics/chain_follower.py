"""One turtle of a chain: it is spawned, and keeps a distance to the one before it."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, LookupException, TransformException, TransformListener
from turtlesim.srv import Spawn


class ChainFollower(Node):
    def __init__(self):
        super().__init__("chain_follower")
        self.me = self.declare_parameter("me", "turtle2").value
        self.leader = self.declare_parameter("leader", "turtle1").value
        self.gap = self.declare_parameter("gap", 1.0).value
        self.lag = Duration(seconds=0.5)
        self.buffer = Buffer(node=self)
        TransformListener(self.buffer, self)
        self.publisher = self.create_publisher(Twist, f"{self.me}/cmd_vel", 1)
        self.spawn(self.declare_parameter("start", [1.0, 1.0]).value)
        self.create_timer(0.1, self.follow)

    def spawn(self, start):
        client = self.create_client(Spawn, "spawn")
        while not client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info("no turtlesim yet")
        client.call_async(Spawn.Request(x=start[0], y=start[1], name=self.me))

    def follow(self):
        try:
            now = self.get_clock().now()
            seen = self.buffer.lookup_transform_full(self.me, Time(), self.leader, now - self.lag, "world")
        except LookupException:
            return
        except TransformException as error:
            self.get_logger().warning(f"{error}", throttle_duration_sec=5.0)
            return
        there = seen.transform.translation
        away = math.hypot(there.x, there.y)
        command = Twist()
        command.linear.x = max(0.0, 1.5 * (away - self.gap))
        command.angular.z = 4.0 * math.atan2(there.y, there.x) if away > 0.1 else 0.0
        self.publisher.publish(command)


def main():
    rclpy.init()
    try:
        rclpy.spin(ChainFollower())
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
