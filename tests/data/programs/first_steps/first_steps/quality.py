"""The talker and the listener of the programs about quality of service."""
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):

    def __init__(self, topic, qos_profile, event_callbacks, count=0, assert_topic_period=None):
        super().__init__('qos_talker')
        self.publisher = self.create_publisher(String, topic, qos_profile, event_callbacks=event_callbacks)
        self.publish_timer = self.create_timer(0.5, self.publish)
        self.assert_topic_timer = None
        if assert_topic_period:
            self.assert_topic_timer = self.create_timer(assert_topic_period, self.publisher.assert_liveliness)
        self.pause_timer = None
        self.publish_count = 0
        self.stop_at_count = count

    def pause_for(self, seconds):
        if self.pause_timer:
            return
        self.publish_timer.cancel()
        self.pause_timer = self.create_timer(seconds, self._pause_expired)

    def _pause_expired(self):
        self.publish()
        self.publish_timer.reset()
        self.destroy_timer(self.pause_timer)
        self.pause_timer = None

    def publish(self):
        message = String()
        message.data = 'Talker says {}'.format(self.publish_count)
        self.get_logger().info('Publishing: {}'.format(message.data))
        self.publish_count += 1
        if self.stop_at_count > 0 and self.publish_count >= self.stop_at_count:
            self.publish_timer.cancel()
        self.publisher.publish(message)

    def stop(self):
        if self.assert_topic_timer:
            self.assert_topic_timer.cancel()
        self.publish_timer.cancel()
        self.assert_topic_timer = None


class Listener(Node):

    def __init__(self, topic, qos_profile, event_callbacks, defer_subscribe=False):
        super().__init__('qos_listener')
        self.subscription = None
        self.topic, self.qos_profile, self.event_callbacks = topic, qos_profile, event_callbacks
        if not defer_subscribe:
            self.start_listening()

    def start_listening(self):
        if not self.subscription:
            self.subscription = self.create_subscription(
                String, self.topic, self._message_callback, self.qos_profile,
                event_callbacks=self.event_callbacks)
            self.get_logger().info('Subscription created')

    def _message_callback(self, message):
        self.get_logger().info('I heard: {}'.format(message.data))


def main():
    print('import me')
