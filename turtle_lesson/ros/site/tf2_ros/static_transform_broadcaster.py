"""Tells on /tf_static where frames are that never move.

Facts: geometry2, tf2_ros_py/tf2_ros/static_transform_broadcaster.py (Jazzy).
"""

from __future__ import annotations

from collections.abc import Iterable

from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from .transform_broadcaster import as_list


class StaticTransformBroadcaster:
    """Publishes transforms once, for all subscriptions of now and later.

    All frames of one broadcaster go into one message. The first transform of a frame counts; a later
    one of the same frame is ignored, as by the real one, which says nothing; here it is said in the log.
    """

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        if qos is None:
            qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, history=HistoryPolicy.KEEP_LAST)
        self.pub_tf = node.create_publisher(TFMessage, "/tf_static", qos)
        self.net_message = TFMessage()
        self._logger = node.get_logger()

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:
        """Publish one transform, or several, with all those from before."""
        known = {each.child_frame_id: each for each in self.net_message.transforms}
        for new in as_list(transform):
            old = known.setdefault(new.child_frame_id, new)
            if old is new:
                self.net_message.transforms.append(new)
            elif old.transform != new.transform or old.header.frame_id != new.header.frame_id:
                self._logger.warning(
                    f"'{new.child_frame_id}' was sent before, and on /tf_static the first transform of a frame counts: "
                    "this one is ignored. Use a TransformBroadcaster for a frame that moves."
                )
        self.pub_tf.publish(self.net_message)
