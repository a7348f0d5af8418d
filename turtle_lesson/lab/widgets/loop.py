"""The notebook's event loop: what widgets do happens there and nowhere else.

A message from the browser may arrive in another thread with a loop of its own (ipykernel 7 with JupyterLab 4.6 does so now
and then), and greenlets cannot change thread. So each callback of a widget hops to the loop in which cells run.
"""

from __future__ import annotations

import asyncio
from _thread import get_ident  # of the system's thread, whichever robot process is at work in it
from collections.abc import Callable
from typing import Any


class Loop:
    """The event loop of the cell in which this is made; without one (a plain script) calls happen at once."""

    def __init__(self) -> None:
        self.thread = get_ident()
        try:
            self._loop: asyncio.AbstractEventLoop | None = asyncio.get_running_loop()
        except RuntimeError:
            self._loop = None

    def soon(self, action: Callable[..., object], *arguments: Any) -> None:
        """Have the loop call `action`, whichever thread this is. Actions keep their order."""
        if self._loop is None:
            action(*arguments)
        else:
            self._loop.call_soon_threadsafe(action, *arguments)

    def now_or_soon(self, action: Callable[..., object], *arguments: Any) -> None:
        """Call `action` at once if this is the loop's thread, otherwise have the loop call it."""
        if get_ident() == self.thread:
            action(*arguments)
        else:
            self.soon(action, *arguments)

    def hopping(self, action: Callable[..., object]) -> Callable[..., None]:
        """`action` as a callback that may be called from any thread."""

        def hop(*arguments: Any) -> None:
            self.soon(action, *arguments)

        return hop

    def every(self, seconds: float, action: Callable[[], object]) -> asyncio.Task[None] | None:
        """Call `action` again and again; cancel the task to end that. None where there is no loop."""
        return None if self._loop is None else self._loop.create_task(_again_and_again(seconds, action))


async def _again_and_again(seconds: float, action: Callable[[], object]) -> None:
    loop = asyncio.get_running_loop()
    due = loop.time()
    while True:
        due = max(due + seconds, loop.time())
        await asyncio.sleep(due - loop.time())
        action()
