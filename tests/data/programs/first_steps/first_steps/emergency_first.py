"""An executor of one's own: what is urgent has threads of its own."""
import time
from concurrent.futures import ThreadPoolExecutor
import multiprocessing

import rclpy
from rclpy.executors import Executor, ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Empty, String


class Stopper(Node):

    def __init__(self):
        super().__init__('stopper')
        self.sub = self.create_subscription(Empty, 'stop', self.stop, 10)

    def stop(self, msg):
        self.get_logger().warn('stopped')


class Worker(Node):

    def __init__(self):
        super().__init__('worker')
        self.sub = self.create_subscription(String, 'work', self.work, 10)

    def work(self, msg):
        self.get_logger().info('begins ' + msg.data)
        time.sleep(1.0)
        self.get_logger().info('ends ' + msg.data)


class PriorityExecutor(Executor):

    def __init__(self):
        super().__init__()
        self.high_priority_nodes = set()
        self.hp_executor = ThreadPoolExecutor(max_workers=multiprocessing.cpu_count() or 4)
        self.lp_executor = ThreadPoolExecutor(max_workers=1)

    def add_high_priority_node(self, node):
        self.high_priority_nodes.add(node)
        # add_node inherited
        self.add_node(node)

    def spin_once(self, timeout_sec=None):
        try:
            handler, group, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
        except StopIteration:
            pass
        else:
            if node in self.high_priority_nodes:
                self.hp_executor.submit(handler)
            else:
                self.lp_executor.submit(handler)


def main(args=None):
    try:
        with rclpy.init(args=args):
            executor = PriorityExecutor()
            executor.add_high_priority_node(Stopper())
            executor.add_node(Worker())
            executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
