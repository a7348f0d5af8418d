"""A publisher of any type, given by its name; its values are JSON."""
import argparse
import importlib
import json
import time

import rclpy
import rclpy.utilities


def publisher(message_type, values):
    package, _, name = message_type.partition('/')
    kind = getattr(importlib.import_module(package + '.msg'), name)
    rclpy.init()
    node = rclpy.create_node('publisher_%s_%s' % (package, name))
    pub = node.create_publisher(kind, 'topic_%s_%s' % (package, name), 10)
    msg = kind()
    for field, value in json.loads(values).items():
        setattr(msg, field, type(getattr(msg, field))(value))
    print('publisher: beginning loop')
    while rclpy.ok():
        pub.publish(msg)
        print('publishing %r' % msg)
        time.sleep(1)
    rclpy.shutdown()


def main():
    parser = argparse.ArgumentParser(formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument('message_type', nargs='?', default='std_msgs/String', help='type of the message')
    parser.add_argument('values', nargs='?', default='{}', help='the message as JSON')
    args = parser.parse_args(rclpy.utilities.remove_ros_args()[1:])
    try:
        publisher(args.message_type, args.values)
    except KeyboardInterrupt:
        print('publisher stopped cleanly')


if __name__ == '__main__':
    main()
