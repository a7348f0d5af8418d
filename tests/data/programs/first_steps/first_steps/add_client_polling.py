"""Sends a request and looks at its future after each turn; meanwhile a timer ticks."""
import rclpy
from example_interfaces.srv import AddTwoInts


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node('add_client_polling')
    cli = node.create_client(AddTwoInts, 'add_two_ints')
    req = AddTwoInts.Request()
    req.a = 41
    req.b = 1
    while not cli.wait_for_service(timeout_sec=1.0):
        node.get_logger().info('service not available, waiting again...')
    future = cli.call_async(req)
    node.create_timer(0.4, lambda: node.get_logger().info('still here'))
    while rclpy.ok():
        rclpy.spin_once(node)
        if future.done():
            try:
                result = future.result()
            except Exception as e:
                node.get_logger().info('Service call failed %r' % (e,))
            else:
                node.get_logger().info('%d + %d = %d' % (req.a, req.b, result.sum))
            break
    node.destroy_node()
    rclpy.shutdown()
