"""A talker that pauses, and whoever expects a message in time."""
import argparse

import rclpy
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.logging import get_logger
from rclpy.qos import QoSProfile
from rclpy.qos_event import PublisherEventCallbacks, SubscriptionEventCallbacks

from .quality import Listener, Talker


def parse_args():
    parser = argparse.ArgumentParser()
    parser.add_argument('deadline', type=int, help='in milliseconds')
    parser.add_argument('--publish-for', type=int, default=2000)
    parser.add_argument('--pause-for', type=int, default=1000)
    return parser.parse_args()


def main(args=None):
    parsed_args = parse_args()
    rclpy.init(args=args)
    topic = 'qos_deadline_chatter'
    qos_profile = QoSProfile(depth=10, deadline=Duration(seconds=parsed_args.deadline / 1000.0))
    listener = Listener(topic, qos_profile, SubscriptionEventCallbacks(
        deadline=lambda event: get_logger('Listener').info(str(event))))
    talker = Talker(topic, qos_profile, PublisherEventCallbacks(
        deadline=lambda event: get_logger('Talker').info(str(event))))
    publish_for_seconds = parsed_args.publish_for / 1000.0
    pause_for_seconds = parsed_args.pause_for / 1000.0
    pause_timer = talker.create_timer(  # noqa: F841
        publish_for_seconds, lambda: talker.pause_for(pause_for_seconds))
    executor = SingleThreadedExecutor()
    executor.add_node(listener)
    executor.add_node(talker)
    executor.spin()
    rclpy.shutdown()
