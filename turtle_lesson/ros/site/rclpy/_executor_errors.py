"""What ends an executor's wait, and how long it may be. Everybody knows these as `rclpy.executors.…`."""

from __future__ import annotations


class TimeoutException(Exception):
    """Nothing became ready in time."""

    __module__ = "rclpy.executors"


class ShutdownException(Exception):
    """The executor was shut down."""

    __module__ = "rclpy.executors"


class ExternalShutdownException(Exception):
    """The context was shut down while the executor was waiting."""

    __module__ = "rclpy.executors"


class ConditionReachedException(Exception):
    """What was waited for has happened."""

    __module__ = "rclpy.executors"


class TimeoutObject:
    """A timeout (s) that can be changed while somebody has it."""

    __module__ = "rclpy.executors"
    timeout: float

    def __init__(self, timeout: float) -> None:
        self.timeout = timeout
