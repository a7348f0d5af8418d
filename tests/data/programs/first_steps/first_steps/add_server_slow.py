"""An old-school server with a global node; it thinks for a second."""
import time

import rclpy
from example_interfaces.srv import AddTwoInts

g_node = None


def add(request, response):
    time.sleep(1.0)
    response.sum = request.a + request.b
    return response


def main(args=None):
    global g_node
    rclpy.init(args=args)
    g_node = rclpy.create_node('add_server_slow')
    srv = g_node.create_service(AddTwoInts, 'add_two_ints', add)
    while rclpy.ok():
        rclpy.spin_once(g_node)
    g_node.destroy_service(srv)
    rclpy.shutdown()
