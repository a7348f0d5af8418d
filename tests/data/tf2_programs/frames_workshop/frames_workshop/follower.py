"""Spawns turtle2, and lets it follow a frame."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from tf2_ros import TransformException
from tf2_ros.buffer import Buffer
from tf2_ros.transform_listener import TransformListener
from turtlesim.srv import Spawn


class Follower(Node):
    def __init__(self):
        super().__init__("follower")
        self.target = self.declare_parameter("target_frame", "turtle1").value
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.spawner = self.create_client(Spawn, "spawn")
        self.spawned = None
        self.publisher = self.create_publisher(Twist, "turtle2/cmd_vel", 1)
        self.create_timer(1.0, self.on_timer)

    def on_timer(self):
        if self.spawned is None:
            if self.spawner.service_is_ready():
                self.spawned = self.spawner.call_async(Spawn.Request(name="turtle2", x=4.0, y=2.0, theta=0.0))
            else:
                self.get_logger().info("Service is not ready")
        elif self.spawned.done():
            self.follow()

    def follow(self):
        try:
            seen = self.buffer.lookup_transform("turtle2", self.target, rclpy.time.Time())
        except TransformException as error:
            self.get_logger().info(f"Could not transform turtle2 to {self.target}: {error}")
            return
        there = seen.transform.translation
        command = Twist()
        command.angular.z = 1.0 * math.atan2(there.y, there.x)
        command.linear.x = 0.5 * math.hypot(there.x, there.y)
        self.publisher.publish(command)


def main():
    rclpy.init()
    try:
        rclpy.spin(Follower())
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
