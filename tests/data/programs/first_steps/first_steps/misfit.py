import sys

import rclpy
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks, UnsupportedEventTypeError
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.logging import get_logger
from rclpy.qos import QoSDurabilityPolicy, QoSLivelinessPolicy, QoSProfile, QoSReliabilityPolicy

from first_steps.quality import Listener, Talker

POLICIES = {
    'durability': (QoSDurabilityPolicy.VOLATILE, QoSDurabilityPolicy.TRANSIENT_LOCAL),
    'deadline': (Duration(seconds=2), Duration(seconds=1)),
    'liveliness': (QoSLivelinessPolicy.AUTOMATIC, QoSLivelinessPolicy.MANUAL_BY_TOPIC),
    'liveliness_lease_duration': (Duration(seconds=2), Duration(seconds=1)),
    'reliability': (QoSReliabilityPolicy.BEST_EFFORT, QoSReliabilityPolicy.RELIABLE),
}


def main(args=None):
    name = sys.argv[1]
    qos_profile_publisher = QoSProfile(depth=10)
    qos_profile_subscription = QoSProfile(depth=10)
    setattr(qos_profile_publisher, name, POLICIES[name][0])
    setattr(qos_profile_subscription, name, POLICIES[name][1])
    try:
        with rclpy.init(args=args):

            def told(who):
                def callback(event):
                    get_logger(who).info(
                        f'incompatible qos - total {event.total_count} delta {event.total_count_change} '
                        f'last_policy_kind: {event.last_policy_kind}')
                return callback

            try:
                talker = Talker(
                    'incompatible_qos_chatter', qos_profile_publisher,
                    PublisherEventCallbacks(incompatible_qos=told('talker')), count=2)
                listener = Listener(
                    'incompatible_qos_chatter', qos_profile_subscription,
                    SubscriptionEventCallbacks(incompatible_qos=told('listener')))
            except UnsupportedEventTypeError as exc:
                print(exc, end='\n\n')
                return 1
            executor = SingleThreadedExecutor()
            executor.add_node(listener)
            executor.add_node(talker)
            while talker.publish_count < 2:
                executor.spin_once()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    return 0


if __name__ == '__main__':
    sys.exit(main())
