"""Takes messages as bytes, and reads them itself."""
import rclpy
from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message
from std_msgs.msg import String


class ByteListener(Node):

    def __init__(self):
        super().__init__('hear_bytes')
        self.sub = self.create_subscription(String, 'topic', self.raw_callback, 10, raw=True)
        self.pub = self.create_publisher(String, 'again', 10)

    def raw_callback(self, msg):
        text = deserialize_message(msg, String)
        self.get_logger().info(f'{len(msg)} bytes, {type(msg).__name__}: {msg[:8].hex()} {text.data}')
        assert serialize_message(text) == msg
        self.pub.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = ByteListener()
    node.create_subscription(String, 'again', lambda m: node.get_logger().info('again ' + m.data), 1)
    rclpy.spin(node)


if __name__ == '__main__':
    main()
