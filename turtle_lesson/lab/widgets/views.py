"""The places in browsers where a widget is to be seen: while there are any, it ticks."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from ...ros.core.virtual_time import real_monotonic
from .loop import Loop

PATIENCE = 150.0
"""Seconds without a sign of life after which a view counts as gone: its window was closed, or its network broke.

A view gives one every 20 s, and a browser may hold up those of a hidden window for a minute.
"""


class Views:
    """The open views of one widget. `tick` is called every `seconds` while there is one."""

    def __init__(
        self,
        loop: Loop,
        seconds: float,
        tick: Callable[[], object],
        opened: Callable[[], object],
        closed: Callable[[], object],
    ) -> None:
        self._loop, self._seconds = loop, seconds
        self._tick, self._opened, self._closed = tick, opened, closed
        self._heard: dict[str, float] = {}
        self._task: asyncio.Task[None] | None = None

    def __len__(self) -> int:
        return len(self._heard)

    def heard(self, view: str) -> None:
        """A view says that it is there."""
        first = not self._heard
        self._heard[str(view)] = real_monotonic()
        if first:
            self._opened()
            self._task = self._loop.every(self._seconds, self._again)
        self._tick()

    def gone(self, view: str) -> None:
        """A view says good-bye."""
        if self._heard.pop(str(view), None) is not None and not self._heard:
            self._stop()

    def clear(self) -> None:
        """No view is there any more."""
        if self._heard:
            self._heard.clear()
            self._stop()

    def _again(self) -> None:
        limit = real_monotonic() - PATIENCE
        for view in [view for view, time in self._heard.items() if time < limit]:
            self.gone(view)
        if self._heard:
            self._tick()

    def _stop(self) -> None:
        if self._task is not None:
            self._task.cancel()
            self._task = None
        self._closed()
