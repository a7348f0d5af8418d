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
from rclpy._rclpy_pybind11 import InvalidHandle
from rclpy.callback_groups import CallbackGroup

HUMBLE = os.environ.get("STANDIN") == "humble"


class Subscription(_network.End):
    if not HUMBLE:

        class CallbackType(Enum):
            MessageOnly = 0
            WithMessageInfo = 1

    def __init__(
        self,
        node: Any,
        kind: Any,
        topic: str,
        callback: Callable[..., Any],
        qos: Any,
        raw: bool,
        callback_group: CallbackGroup | None,
    ) -> None:
        self.msg_type, self.raw, self.callback_group = kind, raw, callback_group
        self.handle = Handle(self)
        self.callback, self._with_info = callback, not HUMBLE and not _fits(callback, 1)
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
        self._queue.append((b"its bytes" if self.raw else copy.deepcopy(message), stamp))
        if self._is_awaited():
            self._node._wake()

    def _is_awaited(self) -> bool:
        return self.callback_group is None or self.callback_group.can_execute(self)

    def _ready(self) -> Callable[[], Any] | None:
        if not self._queue or not self._is_awaited():
            return None
        message, info = self._pop()
        return (lambda: self.callback(message, info)) if self._with_info else lambda: self.callback(message)

    def _pop(self) -> tuple[Any, dict[str, int]]:
        message, stamp = self._queue.popleft()
        return message, {"source_timestamp": stamp, "received_timestamp": time.time_ns()}


class Handle:
    """Of a subscription, for those who take its messages themselves; it can be entered as long as that is there."""

    def __init__(self, subscription: Subscription) -> None:
        self._subscription = subscription

    def __enter__(self) -> None:
        if self._subscription not in self._subscription._node._entities:
            raise InvalidHandle("cannot use Destroyable because destruction was requested")

    def __exit__(self, *_: object) -> None:
        pass

    def take_message(self, msg_type: Any, raw: bool) -> tuple[Any, dict[str, int]] | None:
        assert msg_type is self._subscription.msg_type and raw == self._subscription.raw
        return self._subscription._pop() if self._subscription._queue else None


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
