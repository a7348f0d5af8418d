"""A publisher whose timer calls a function inside of main."""
import rclpy
from std_msgs.msg import String


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node('talk_local_function')
    publisher = node.create_publisher(String, 'topic', 10)
    msg = String()
    i = 0

    def tick():
        nonlocal i
        msg.data = f'Hello: {i}'
        i += 1
        node.get_logger().info(f'Publishing: "{msg.data}"')
        publisher.publish(msg)

    timer = node.create_timer(0.5, tick)
    rclpy.spin(node)

    node.destroy_timer(timer)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
