import rclpy
from rclpy.wait_for_message import wait_for_message
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('wait_once')
    for topic in ('silence', 'topic'):
        found, msg = wait_for_message(String, node, topic, time_to_wait=1.0)
        print(topic, found, msg)
    print('seconds', round((node.get_clock().now().nanoseconds / 1e9) % 1000, 1))
