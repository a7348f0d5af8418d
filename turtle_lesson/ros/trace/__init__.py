"""A trace: what happened in a world, noted from outside, as ros2_tracing does on a robot.

It notes when messages are published, when callbacks run, and when services are called and answer. Nothing in the system can
see it, and a world without a trace pays nothing for it but a look at an attribute.
"""

from .callbacks import Callback
from .calls import Call
from .trace import Trace

__all__ = ["Call", "Callback", "Trace"]
