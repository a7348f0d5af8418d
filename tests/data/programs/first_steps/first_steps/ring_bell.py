"""A guard condition wakes an executor from the main loop."""
import rclpy


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node('ring_bell')
    executor = rclpy.get_global_executor()
    executor.add_node(node)

    def guard_condition_callback():
        guard_condition_callback.called = True
        node.get_logger().info('the bell was rung')

    guard_condition_callback.called = False
    guard_condition = node.create_guard_condition(guard_condition_callback)

    executor.spin_once(timeout_sec=0.5)
    print('before:', guard_condition_callback.called)
    guard_condition.trigger()
    while not guard_condition_callback.called:
        executor.spin_once(timeout_sec=1)
    print('after:', guard_condition_callback.called)
    node.destroy_guard_condition(guard_condition)
    rclpy.shutdown()


if __name__ == '__main__':
    main()
