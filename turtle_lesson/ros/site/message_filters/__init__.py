"""Filters that messages run through: by subscription, by time, in a history, or in step with other topics.

Facts: ros2/message_filters, src/message_filters/__init__.py. What is of C++ alone (`TimeSequencer`, other policies of
synchronising) is not here either.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ._cache import Cache
from ._chain import Chain
from ._filters import SimpleFilter, Subscriber
from ._synchronizers import ApproximateTimeSynchronizer, TimeSynchronizer

__all__ = ["ApproximateTimeSynchronizer", "Cache", "Chain", "SimpleFilter", "Subscriber", "TimeSynchronizer"]

if not TYPE_CHECKING:
    from rclpy._missing import explain_missing

    __getattr__ = explain_missing(__name__)
