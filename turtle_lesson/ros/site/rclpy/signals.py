"""Which signals rclpy handles. In the simulation only SIGINT exists: it raises KeyboardInterrupt in the process."""

from enum import Enum


class SignalHandlerOptions(Enum):
    """Choice of `rclpy.init(signal_handler_options=…)`."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3
