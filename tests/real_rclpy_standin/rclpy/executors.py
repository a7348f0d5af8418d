"""The executor: waits, and calls back in the thread that spins it."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from rclpy._rclpy_pybind11 import InvalidHandle
from rclpy.context import Context, get_default_context
from rclpy.subscription import HUMBLE
from rclpy.task import Future


class SingleThreadedExecutor:
    def __init__(self, *, context: Context | None = None) -> None:
        self._context = context or get_default_context()
        self._context.executors.append(self)
        self._nodes: list[Any] = []
        self._tasks: deque[Any] = deque()
        self._news = threading.Condition()
        self._stale = self._is_shutdown = False
        self._thread = 0

    def add_node(self, node: Any) -> bool:
        node.executor = self
        self._nodes.append(node)
        self.wake()
        return True

    def create_task(self, callback: Callable[..., Any], *arguments: Any) -> Future:
        future = Future()
        self._tasks.append(lambda: future.set_result(callback(*arguments)))
        self.wake()
        return future

    def wake(self) -> None:
        with self._news:
            self._news.notify_all()

    def spin(self) -> None:
        while self._context.ok() and not self._is_shutdown:
            self.spin_once()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        self._thread = threading.get_ident()
        end = None if timeout_sec is None else time.monotonic() + timeout_sec
        work = self._wait(end)
        if work is not None:
            work()

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        self._is_shutdown = True
        self._nodes = []
        self.wake()
        return True

    def _wait(self, end: float | None) -> Callable[[], Any] | None:
        with self._news:
            while self._context.ok() and not self._is_shutdown:
                if self._stale:
                    self._stale = False
                    raise InvalidHandle("cannot use Destroyable because destruction was requested")
                work = self._find()
                if work is not None:
                    return work
                now = time.monotonic()
                if end is not None and now >= end:
                    return None
                due = [timer._due for node in self._nodes for timer in node._timers]
                self._news.wait(max(0.0, min([*due, end or now + 60, now + 60]) - now))
        return None

    def _find(self) -> Callable[[], Any] | None:
        if self._tasks:
            return self._tasks.popleft()
        for node in list(self._nodes):
            for entity in [*node._timers, *node._entities]:
                work = entity._ready()
                if work is not None:
                    return work
        return None

    def _was_destroyed(self) -> None:
        """An entity is gone: in Humble, `spin_once` stumbles over it if another thread did that."""
        self._stale = HUMBLE and threading.get_ident() != self._thread
        self.wake()
