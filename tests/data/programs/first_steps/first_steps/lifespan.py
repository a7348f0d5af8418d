"""A listener that comes late finds only what has not expired: lifespan in ms, how many messages, and when it comes."""
import sys

import rclpy
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy

from first_steps.quality import Listener, Talker


def main(args=None):
    lifespan, count, subscribe_after = (int(each) for each in sys.argv[1:4])
    rclpy.init(args=args)
    qos_profile = QoSProfile(
        depth=10,
        reliability=QoSReliabilityPolicy.RMW_QOS_POLICY_RELIABILITY_RELIABLE,
        durability=QoSDurabilityPolicy.RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL,
        lifespan=Duration(seconds=lifespan / 1000))
    listener = Listener('qos_lifespan_chatter', qos_profile, event_callbacks=None, defer_subscribe=True)
    talker = Talker('qos_lifespan_chatter', qos_profile, event_callbacks=None, count=count)
    subscribe_timer = listener.create_timer(  # noqa: F841
        subscribe_after / 1000, lambda: listener.start_listening())
    executor = SingleThreadedExecutor()
    executor.add_node(listener)
    executor.add_node(talker)
    executor.spin()
    rclpy.shutdown()
