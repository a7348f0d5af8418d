"""One callback sleeps; whether the other runs meanwhile is a matter of their groups. Argument: same, own or reentrant."""
import sys
import time

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from std_msgs.msg import String


class DoubleTalker(Node):

    def __init__(self, kind):
        super().__init__('double_talker')
        self.i = 0
        self.pub = self.create_publisher(String, 'chatter', 10)
        groups = {
            'same': [MutuallyExclusiveCallbackGroup()] * 2,
            'own': [MutuallyExclusiveCallbackGroup(), MutuallyExclusiveCallbackGroup()],
            'reentrant': [ReentrantCallbackGroup()] * 2,
        }[kind]
        self.timer = self.create_timer(1.0, self.slow, callback_group=groups[0])
        self.timer2 = self.create_timer(0.5, self.quick, callback_group=groups[1])

    def slow(self):
        self.get_logger().info('slow begins')
        time.sleep(0.8)
        self.get_logger().info('slow ends')

    def quick(self):
        self.pub.publish(String(data='Hello World: {0}'.format(self.i)))
        self.get_logger().info(f'quick {self.i}')
        self.i += 1


def main(args=None):
    rclpy.init(args=args)
    kind = remove_ros_args(sys.argv)[1]
    try:
        node = DoubleTalker(kind)
        executor = MultiThreadedExecutor(num_threads=4)
        executor.add_node(node)
        try:
            executor.spin()
        finally:
            executor.shutdown()
            node.destroy_node()
    finally:
        rclpy.try_shutdown()
