"""Executors: they wait until callbacks are ready, and run them. How they do it is in `_executor.py`."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from ._borrowed import borrowed
from ._executor import Executor
from ._executor_errors import (
    ConditionReachedException,
    ExternalShutdownException,
    ShutdownException,
    TimeoutException,
    TimeoutObject,
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
    "TimeoutObject",
    "await_or_execute",
]


async def await_or_execute(callback: Callable[..., Any], *args: Any) -> Any:
    """Call a function, and if it is a coroutine's wait for its end."""
    return await callback(*args) if inspect.iscoroutinefunction(callback) else callback(*args)


class SingleThreadedExecutor(Executor):
    """Runs one callback after the other, in the thread that spins: a callback that sleeps holds up all others."""


__getattr__ = borrowed(__name__)
