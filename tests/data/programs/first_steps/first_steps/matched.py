"""Who comes and goes at the other end."""
import rclpy
from rclpy.event_handler import PublisherEventCallbacks, QoSPublisherMatchedInfo, SubscriptionEventCallbacks
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import String


class Watcher(Node):

    def __init__(self):
        super().__init__('watcher')
        self.future: Future = Future()
        self.pub = self.create_publisher(
            String, 'a', 10, event_callbacks=PublisherEventCallbacks(matched=self.__on_subscription))
        self.sub = self.create_subscription(
            String, 'b', lambda msg: None, 10,
            event_callbacks=SubscriptionEventCallbacks(matched=self.__on_publisher))

    def __on_subscription(self, info: QoSPublisherMatchedInfo) -> None:
        self.get_logger().info(f'subscriptions: {info.current_count} ({info.current_count_change:+d})')
        self.future.set_result(True)

    def __on_publisher(self, info) -> None:
        self.get_logger().info(f'publishers: {info.current_count} ({info.current_count_change:+d})')
        self.future.set_result(True)

    def next_change(self) -> Future:
        self.future = Future()
        return self.future


def main(args=None):
    with rclpy.init(args=args):
        watcher, other = Watcher(), Node('other')
        executor = SingleThreadedExecutor()
        for node in (watcher, other):
            executor.add_node(node)

        def wait():
            executor.spin_until_future_complete(watcher.next_change(), 10)

        subs = []
        for _ in range(2):
            subs.append(other.create_subscription(String, 'a', lambda msg: None, 10))
            wait()
        for sub in subs:
            other.destroy_subscription(sub)
            wait()
        pub = other.create_publisher(String, 'b', 10)
        wait()
        other.destroy_publisher(pub)
        wait()
