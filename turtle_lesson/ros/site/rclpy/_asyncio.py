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

    call._at_once = True  # type: ignore[attr-defined]
    return call
