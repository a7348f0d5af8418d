"""Futures of rclpy's in asyncio's coroutines: a program may await them there, and call `rclpy.spin_once` beside that.

The real ones are asked in every round of the loop whether they are done; those here tell the loop.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.core import running_strand

if TYPE_CHECKING:
    from .task import Future


FOR_ALL = object()
"""Stands for a future that is cancelled for good, not only for one of asyncio's coroutines."""


def refuse_in_a_cell() -> None:
    """Raise RuntimeError in a coroutine of the notebook's own loop: while that one waits, no robot time passes."""
    if running_strand() is None and asyncio._get_running_loop() is not None:
        raise RuntimeError(
            "a future of rclpy's cannot be awaited in a cell: no robot time would pass meanwhile. Write "
            "rclpy.spin_until_future_complete(node, future), then future.result()."
        )


def called_by_its_loop(callback: Callable[..., Any], context: Any) -> Callable[[Future], None]:
    """A done callback of asyncio's, to be called by the loop that runs now."""
    loop = asyncio.get_running_loop()

    def call(future: Future) -> None:
        loop.call_soon_threadsafe(callback, future, context=context)

    call._at_once = call._of_asyncio = True  # type: ignore[attr-defined]
    return call


def let_asyncio_go_on(future: Future) -> bool:
    """Wake the coroutines of asyncio's that await a future: one of them is cancelled, the others wait on."""
    callbacks = [each for each in future._callbacks if getattr(each, "_of_asyncio", False)]
    for callback in callbacks:
        future._callbacks.remove(callback)
        callback(future)
    return False
