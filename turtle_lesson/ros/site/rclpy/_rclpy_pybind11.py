"""The exceptions that the real rclpy gets from its C++ half, under the names by which tracebacks print them.

Nothing else of that half is here: what stands in its place is Python.
"""

from __future__ import annotations


class InvalidHandle(RuntimeError):
    """Something is used after it was destroyed."""


class RMWError(RuntimeError):
    """An error that the real rclpy gets from the middleware."""


class RCLError(RuntimeError):
    """An error that the real rclpy gets from the C library rcl."""


class RCLInvalidROSArgsError(RCLError):
    """A node's ROS arguments cannot be read. (For those of a whole process it is the base class.)"""


class UnknownROSArgsError(RuntimeError):
    """There are words after `--ros-args` that mean nothing."""


class NodeNameNonExistentError(RCLError):
    """The graph has no node of this name."""


class UnsupportedEventTypeError(RCLError):
    """The middleware knows no such event."""


class TimerCancelledError(RCLError):
    """A cancelled timer is called."""
