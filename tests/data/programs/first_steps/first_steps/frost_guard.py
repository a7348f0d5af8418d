"""A thermometer, and a guard that hears only of frost and fire; a parameter moves the border of frost."""
import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.subscription_content_filter_options import ContentFilterOptions
from std_msgs.msg import Float32

WARM, STEP = 70.0, 20.0


class Thermometer(Node):

    def __init__(self):
        super().__init__('thermometer')
        self.degrees = -50.0
        self.publisher = self.create_publisher(Float32, 'temperature', 10)
        self.create_timer(0.5, self.measure)

    def measure(self):
        self.get_logger().info(f'It is {self.degrees:.1f} degrees')
        self.publisher.publish(Float32(data=self.degrees))
        self.degrees = self.degrees + STEP if self.degrees < WARM + STEP else -50.0


class Guard(Node):

    def __init__(self):
        super().__init__('guard')
        frost = self.declare_parameter('frost', 0.0).value
        self.subscription = self.create_subscription(
            Float32, 'temperature', self.warn, 10,
            content_filter_options=ContentFilterOptions('data < %0 OR data > %1', [str(frost), str(WARM)]))
        self.add_post_set_parameters_callback(self.move_border)
        if self.subscription.is_cft_enabled:
            expression, parameters = self.subscription.get_content_filter()
            self.get_logger().info(f'listening for {expression} with {", ".join(parameters)}')
        else:
            self.get_logger().warn('this middleware has no content filters')

    def move_border(self, parameters):
        for each in parameters:
            if each.name == 'frost':
                self.subscription.set_content_filter('data < %0 OR data > %1', [str(each.value), str(WARM)])

    def warn(self, message):
        self.get_logger().warn(f'{"Frost" if message.data < WARM else "Fire"}: {message.data:.1f}')


def main(args=None):
    rclpy.init(args=args)
    node = Thermometer() if sys.argv[1] == 'thermometer' else Guard()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        node.destroy_node()


if __name__ == '__main__':
    main()
