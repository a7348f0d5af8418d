"""Subscriptions, and publishers, which feed them."""

from __future__ import annotations

import copy
import inspect
import os
import threading
import time
from collections import deque
from collections.abc import Callable
from enum import Enum
from typing import Any

from rclpy import _network

HUMBLE = os.environ.get("STANDIN") == "humble"


class Subscription(_network.End):
    if not HUMBLE:

        class CallbackType(Enum):
            MessageOnly = 0
            WithMessageInfo = 1

    def __init__(self, node: Any, kind: Any, topic: str, callback: Callable[..., Any], qos: Any, raw: bool) -> None:
        self._raw = raw
        self._callback, self._with_info = callback, not HUMBLE and not _fits(callback, 1)
        if not _fits(callback, 2 if self._with_info else 1):
            raise RuntimeError(
                "Subscription.__init__(): callback should be either be callable with one argument or two"
            )
        self._queue: deque[Any] = deque(maxlen=qos.depth)
        super().__init__("sub", node, topic, kind.type_name, qos)
        if qos.durability == 1:
            threading.Timer(_network.DISCOVERY, self._catch_up).start()

    def _catch_up(self) -> None:
        for publisher in _network.matched(self, "pub"):
            for message, stamp in publisher._history:
                self._put(message, stamp)

    def _put(self, message: Any, stamp: int) -> None:
        self._queue.append((b"its bytes" if self._raw else copy.deepcopy(message), stamp))
        self._node._wake()

    def _ready(self) -> Callable[[], Any] | None:
        if not self._queue:
            return None
        message, stamp = self._queue.popleft()
        if not self._with_info:
            return lambda: self._callback(message)
        info = {"source_timestamp": stamp, "received_timestamp": time.time_ns()}
        return lambda: self._callback(message, info)


class Publisher(_network.End):
    def __init__(self, node: Any, kind: Any, topic: str, qos: Any) -> None:
        self._kind_of_message = kind
        self._history: deque[Any] = deque(maxlen=qos.depth if qos.durability == 1 else 0)
        super().__init__("pub", node, topic, kind.type_name, qos)

    def publish(self, message: Any) -> None:
        if type(message) is not self._kind_of_message:
            raise TypeError(f"Expected {self._kind_of_message}, got {type(message)}")
        stamp = time.time_ns()
        self._history.append((message, stamp))
        for subscription in self._served():
            subscription._put(message, stamp)

    def get_subscription_count(self) -> int:
        return len(self._served())

    def _served(self) -> list[Any]:
        return [each for each in _network.matched(self, "sub") if self._qos.fits(each._qos)]


def _fits(callback: Callable[..., Any], count: int) -> bool:
    try:
        inspect.signature(callback).bind(*[object()] * count)
    except TypeError:
        return False
    return True
