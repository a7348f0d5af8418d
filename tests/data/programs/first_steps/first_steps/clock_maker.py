"""Publishes a clock that runs ten times as slowly."""
import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.time import Time
from rosgraph_msgs.msg import Clock as ClockMsg


class ClockMaker(Node):

    def __init__(self):
        super().__init__('clock_maker')
        self.pub = self.create_publisher(ClockMsg, '/clock', 10)
        self.timer = self.create_timer(0.1, self.tick, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self.passed = 0

    def tick(self):
        self.passed += 10_000_000
        self.pub.publish(ClockMsg(clock=Time(nanoseconds=self.passed).to_msg()))


def main():
    rclpy.init()
    rclpy.spin(ClockMaker())
