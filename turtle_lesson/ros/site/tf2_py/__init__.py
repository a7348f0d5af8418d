"""tf2's core for Python: what remembers transforms, and answers for any two frames at any time.

Names as in tf2_py (geometry2); programs mostly use `tf2_ros.Buffer`, which is a `BufferCore` that can wait.
"""

# ruff: noqa: F401

from ._buffer_core import BufferCore
from ._frames import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)
