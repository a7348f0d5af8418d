"""Hears /tf and /tf_static, and fills a buffer. Facts: geometry2, tf2_ros_py/tf2_ros/transform_listener.py."""

from __future__ import annotations

from contextlib import suppress
from threading import Thread

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from .buffer import Buffer

DEFAULT_TF_TOPIC = "/tf"
DEFAULT_STATIC_TF_TOPIC = "/tf_static"


class TransformListener:
    """Fills a buffer with what is told on /tf and /tf_static, once its node is spun.

    With `spin_thread` a thread of its own spins it; without a node, one is made for it.
    """

    def __init__(
        self,
        buffer: Buffer,
        node: Node | None,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
        tf_topic: str = DEFAULT_TF_TOPIC,
        tf_static_topic: str = DEFAULT_STATIC_TF_TOPIC,
    ) -> None:
        if not hasattr(buffer, "set_transform"):
            raise TypeError(f"TransformListener(buffer, node) fills a Buffer, got {buffer!r} as the buffer")
        self.buffer = buffer
        self.node = node or Node(
            "transform_listener_impl",
            enable_rosout=False,
            start_parameter_services=False,
            parameter_overrides=[Parameter("use_sim_time", value=False)],
        )
        # A group that lets a callback which waits for a transform be interrupted by the one that brings it.
        self.group = ReentrantCallbackGroup()
        node, group, last = self.node, self.group, HistoryPolicy.KEEP_LAST
        qos = qos or QoSProfile(depth=100, durability=DurabilityPolicy.VOLATILE, history=last)
        static_qos = static_qos or QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL, history=last)
        self.tf_sub = node.create_subscription(TFMessage, tf_topic, self.callback, qos, callback_group=group)
        self.tf_static_sub = node.create_subscription(
            TFMessage, tf_static_topic, self.static_callback, static_qos, callback_group=group
        )
        if spin_thread:
            self.executor = SingleThreadedExecutor()
            self.dedicated_listener_thread = Thread(target=self._spin)
            self.dedicated_listener_thread.start()

    def _spin(self) -> None:
        self.executor.add_node(self.node)
        with suppress(ExternalShutdownException):
            self.executor.spin()
        self.executor.remove_node(self.node)

    def unregister(self) -> None:
        """Listen no more."""
        self.node.destroy_subscription(self.tf_sub)
        self.node.destroy_subscription(self.tf_static_sub)

    def callback(self, data: TFMessage) -> None:
        """Put transforms of frames that move into the buffer."""
        for transform in data.transforms:
            self.buffer.set_transform(transform, "default_authority")

    def static_callback(self, data: TFMessage) -> None:
        """Put transforms of frames that never move into the buffer."""
        for transform in data.transforms:
            self.buffer.set_transform_static(transform, "default_authority")
