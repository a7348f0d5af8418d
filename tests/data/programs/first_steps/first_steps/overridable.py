import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos_overriding_options import QosCallbackResult, QoSOverridingOptions
from std_msgs.msg import String


class Listener(Node):

    def __init__(self):
        super().__init__('overridable')
        self.sub = self.create_subscription(
            String, 'topic', self.chatter_callback, 10,
            qos_overriding_options=QoSOverridingOptions.with_default_policies(callback=self.qos_callback))
        self.get_logger().info(f'depth {self.sub.qos_profile.depth}')

    def chatter_callback(self, msg):
        self.get_logger().info('I heard: [%s]' % msg.data)

    def qos_callback(self, qos):
        result = QosCallbackResult()
        if qos.depth <= 10:
            result.successful = True
            return result
        result.successful = False
        result.reason = 'expected qos depth less than 10'
        return result


def main(args=None):
    rclpy.init(args=args)
    node = Listener()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
        node.destroy_node()
