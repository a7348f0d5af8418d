"""Futures: whoever sets the result calls back, in its own thread."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any


class Future:
    def __init__(self, *, executor: Any = None) -> None:
        self._lock = threading.Lock()
        self._done, self._result, self._callbacks = False, None, []

    def done(self) -> bool:
        return self._done

    def result(self) -> Any:
        return self._result

    def set_result(self, result: Any) -> None:
        with self._lock:
            self._result, self._done = result, True
            callbacks, self._callbacks = self._callbacks, []
        for callback in callbacks:
            callback(self)

    def add_done_callback(self, callback: Callable[[Any], Any]) -> None:
        with self._lock:
            if not self._done:
                self._callbacks.append(callback)
                return
        callback(self)
