import argparse

import rclpy
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.logging import get_logger
from rclpy.qos import QoSLivelinessPolicy, QoSProfile
from rclpy.qos_event import PublisherEventCallbacks, SubscriptionEventCallbacks

from first_steps.quality import Listener, Talker

POLICY_MAP = {
    'AUTOMATIC': QoSLivelinessPolicy.RMW_QOS_POLICY_LIVELINESS_AUTOMATIC,
    'MANUAL_BY_TOPIC': QoSLivelinessPolicy.RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC,
}


def main(args=None):
    parser = argparse.ArgumentParser()
    parser.add_argument('lease', type=int)
    parser.add_argument('--policy', choices=POLICY_MAP.keys(), default='AUTOMATIC')
    parser.add_argument('--topic-assert-period', type=int, default=0)
    parsed = parser.parse_args()
    rclpy.init(args=args)
    policy = POLICY_MAP[parsed.policy]
    qos_profile = QoSProfile(
        depth=10, liveliness=policy, liveliness_lease_duration=Duration(seconds=parsed.lease / 1000.0))
    listener = Listener('qos_liveliness_chatter', qos_profile, SubscriptionEventCallbacks(
        liveliness=lambda event: get_logger('Listener').info(str(event))))
    talker = Talker('qos_liveliness_chatter', qos_profile, PublisherEventCallbacks(
        liveliness=lambda event: get_logger('Talker').info(str(event))),
        assert_topic_period=parsed.topic_assert_period / 1000.0)
    executor = SingleThreadedExecutor()

    def kill_talker():
        if policy == QoSLivelinessPolicy.RMW_QOS_POLICY_LIVELINESS_AUTOMATIC:
            executor.remove_node(talker)
            talker.destroy_node()
        else:
            talker.stop()
        kill_timer.cancel()

    kill_timer = listener.create_timer(3.0, kill_talker)
    executor.add_node(listener)
    executor.add_node(talker)
    executor.spin()
    rclpy.shutdown()
