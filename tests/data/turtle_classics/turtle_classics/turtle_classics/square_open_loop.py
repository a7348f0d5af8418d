"""Four sides and four corners by the clock alone, in one function that sleeps."""

import math
import time

import rclpy
from geometry_msgs.msg import Twist

SIDE, SPEED, TURN_SPEED = 2.0, 1.0, math.pi / 4.0
RATE = 20


def drive(publisher, twist, seconds):
    end = time.time() + seconds
    while time.time() < end:
        publisher.publish(twist)
        time.sleep(1.0 / RATE)
    publisher.publish(Twist())
    time.sleep(0.2)


def main():
    rclpy.init()
    node = rclpy.create_node("square_open_loop")
    publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
    while publisher.get_subscription_count() == 0:
        time.sleep(0.1)
    forward, turn = Twist(), Twist()
    forward.linear.x = SPEED
    turn.angular.z = TURN_SPEED
    for corner in range(1, 5):
        drive(publisher, forward, SIDE / SPEED)
        drive(publisher, turn, math.pi / 2.0 / TURN_SPEED)
        node.get_logger().info(f"corner {corner}")
    node.destroy_node()
    rclpy.shutdown()
