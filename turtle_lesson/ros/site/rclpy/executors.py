"""Executors: they wait until callbacks are ready, and run them. How they do it is in `_executor.py`."""

from __future__ import annotations

from ._executor import Executor
from ._executor_errors import (
    ConditionReachedException,
    ExternalShutdownException,
    ShutdownException,
    TimeoutException,
)
from ._multi_threaded import MultiThreadedExecutor

__all__ = [
    "ConditionReachedException",
    "Executor",
    "ExternalShutdownException",
    "MultiThreadedExecutor",
    "ShutdownException",
    "SingleThreadedExecutor",
    "TimeoutException",
]


class SingleThreadedExecutor(Executor):
    """Runs one callback after the other, in the thread that spins: a callback that sleeps holds up all others."""
