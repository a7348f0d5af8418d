"""Chases the free turtles: the closest first, or the first that came."""

import math

import rclpy
from geometry_msgs.msg import Twist
from hunt_interfaces.msg import PreyArray
from hunt_interfaces.srv import Catch
from rclpy.node import Node
from turtlesim.msg import Pose


class Hunter(Node):
    def __init__(self):
        super().__init__("hunter")
        self.declare_parameter("closest_first", True)
        self.pose = None
        self.prey = None
        self.caught = 0
        self.create_subscription(Pose, "turtle1/pose", self.on_pose, 10)
        self.create_subscription(PreyArray, "free_turtles", self.on_free, 10)
        self.publisher = self.create_publisher(Twist, "turtle1/cmd_vel", 10)
        self.client = self.create_client(Catch, "catch_turtle")
        self.create_timer(0.01, self.chase)

    def on_pose(self, pose):
        self.pose = pose

    def on_free(self, message):
        if not message.free or self.pose is None:
            self.prey = None
        elif self.get_parameter("closest_first").value:
            self.prey = min(message.free, key=lambda each: math.dist((each.x, each.y), (self.pose.x, self.pose.y)))
        else:
            self.prey = message.free[0]

    def chase(self):
        if self.pose is None or self.prey is None:
            return
        ahead, aside = self.prey.x - self.pose.x, self.prey.y - self.pose.y
        command = Twist()
        if math.hypot(ahead, aside) > 0.5:
            command.linear.x = 2.0 * math.hypot(ahead, aside)
            turn = math.atan2(aside, ahead) - self.pose.theta
            if turn > math.pi:
                turn -= 2 * math.pi
            elif turn < -math.pi:
                turn += 2 * math.pi
            command.angular.z = 6.0 * turn
        else:
            self.catch(self.prey.name)
            self.prey = None
        self.publisher.publish(command)

    def catch(self, name):
        future = self.client.call_async(Catch.Request(name=name))
        future.add_done_callback(lambda done: self.on_caught(name, done.result()))

    def on_caught(self, name, response):
        if response.success:
            self.caught += 1
            self.get_logger().info(f"caught {name}, {self.caught} so far")
        else:
            self.get_logger().error(f"{name} got away")


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(Hunter())
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
