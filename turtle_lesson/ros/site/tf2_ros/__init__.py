"""tf2 for ROS nodes: broadcasters that tell where frames are, a listener that hears it, and a buffer that answers."""

# ruff: noqa: F401

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import TransformStamped
from rclpy.duration import Duration
from rclpy.time import Time
from tf2_py import (
    BufferCore,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

from .buffer import Buffer
from .buffer_interface import BufferInterface, TransformRegistration, TypeException
from .static_transform_broadcaster import StaticTransformBroadcaster
from .transform_broadcaster import TransformBroadcaster
from .transform_listener import TransformListener

_NOT_HERE = {
    "ConvertRegistration": "data is transformed as messages only; register with TransformRegistration",
    "convert": "data is transformed as messages only",
    "BufferClient": "ask a Buffer with a TransformListener instead",
    "StaticTransformListener": "a TransformListener also receives /tf_static",
}


def __getattr__(name: str) -> Any:
    if name in _NOT_HERE:
        raise NotImplementedError(f"tf2_ros.{name} is not available here: {_NOT_HERE[name]}")
    raise AttributeError(f"module 'tf2_ros' has no attribute {name!r}")
