import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos_event import SubscriptionEventCallbacks
from rclpy.time import Time
from sensor_msgs.msg import Image


class MessageLostListener(Node):

    def __init__(self):
        super().__init__('hear_lost')
        event_callbacks = SubscriptionEventCallbacks(message_lost=self._lost)
        self.subscription = self.create_subscription(
            Image, 'pictures', self._message_callback, 1, event_callbacks=event_callbacks)

    def _message_callback(self, message):
        diff = self.get_clock().now() - Time.from_msg(message.header.stamp)
        self.get_logger().info(f'I heard an Image, {diff.nanoseconds > 0}')

    def _lost(self, status):
        self.get_logger().info(f'lost: {status.total_count_change} of {status.total_count}')


def main():
    rclpy.init(args=None)
    executor = SingleThreadedExecutor()
    executor.add_node(MessageLostListener())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
