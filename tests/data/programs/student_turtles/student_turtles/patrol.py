#!/usr/bin/env python3
# A whole project in one class: client, parameters, a thread that works while the executor spins.
import threading

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from turtlesim.srv import TeleportAbsolute


class Patrol(Node):
    def __init__(self):
        super().__init__('patrol')
        self.declare_parameters('', [('route', [1.0, 1.0]), ('names', ['home']), ('tolerance', 0.1)])
        self.group = ReentrantCallbackGroup()
        self.client = self.create_client(TeleportAbsolute, '/turtle1/teleport_absolute', callback_group=self.group)
        self.worker = threading.Thread(target=self.work)
        self.done = threading.Event()
        self.worker.start()

    def work(self):
        self.client.wait_for_service()
        route = self.get_parameter('route').get_parameter_value().double_array_value
        names = self.get_parameter('names').value
        for name, x, y in zip(names, route[::2], route[1::2]):
            self.client.call(TeleportAbsolute.Request(x=x, y=y))
            self.get_logger().info(f'{name}: {x} {y}')
            self.done.wait(0.5)
        self.done.set()


def main(args=None):
    rclpy.init(args=args)
    node = Patrol()
    executor = MultiThreadedExecutor()
    executor.add_node(node)
    while not node.done.is_set():
        executor.spin_once(timeout_sec=0.1)
    node.worker.join()
    print('tolerance', node.get_parameter('tolerance').value)
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown()
