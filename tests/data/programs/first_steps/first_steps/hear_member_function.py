import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from std_msgs.msg import String


class Listener(Node):

    def __init__(self):
        super().__init__('hear_member_function')
        self.subscription = self.create_subscription(
            String, 'topic', self.listener_callback, qos_profile_sensor_data)
        self.subscription  # prevent unused variable warning

    def listener_callback(self, msg):
        self.get_logger().info('I heard: "%s"' % msg.data)


def main(args=None):
    rclpy.init(args=args)
    listener = Listener()
    try:
        rclpy.spin(listener)
    except KeyboardInterrupt:
        print('interrupted')
    except ExternalShutdownException:
        sys.exit(1)
    finally:
        listener.destroy_node()
        rclpy.try_shutdown()
        print('bye')


if __name__ == '__main__':
    main()
