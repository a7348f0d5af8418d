"""Clients and services."""

from __future__ import annotations

import copy
import itertools
from collections import deque
from collections.abc import Callable
from typing import Any

from rclpy import _network
from rclpy.task import Future


class Service(_network.End):
    def __init__(self, node: Any, kind: Any, name: str, callback: Callable[[Any, Any], Any]) -> None:
        self._callback, self._queue = callback, deque[Any]()
        self.srv_type = kind
        super().__init__("srv", node, name, kind.type_name)

    def _ready(self) -> Callable[[], Any] | None:
        if not self._queue:
            return None
        client, number, request = self._queue.popleft()

        def answer() -> None:
            response = self._callback(request, self.srv_type.Response())
            client._queue.append((number, copy.deepcopy(response)))
            client._node._wake()

        return answer


class Client(_network.End):
    def __init__(self, node: Any, kind: Any, name: str) -> None:
        self.srv_type, self.srv_name = kind, name
        self._queue, self._numbers = deque[Any](), itertools.count(1)
        self._pending: dict[int, Future] = {}
        super().__init__("cli", node, name, kind.type_name)

    def service_is_ready(self) -> bool:
        return bool(_network.matched(self, "srv"))

    def call_async(self, request: Any) -> Future:
        if not isinstance(request, self.srv_type.Request):
            raise TypeError
        number, future = next(self._numbers), Future()
        self._pending[number] = future
        future.add_done_callback(self.remove_pending_request)
        for server in _network.matched(self, "srv")[:1]:
            server._queue.append((self, number, copy.deepcopy(request)))
            server._node._wake()
        return future

    def remove_pending_request(self, future: Future) -> None:
        self._pending = {number: each for number, each in self._pending.items() if each is not future}

    def _ready(self) -> Callable[[], Any] | None:
        if not self._queue:
            return None
        number, response = self._queue.popleft()
        future = self._pending.get(number)
        return (lambda: future.set_result(response)) if future is not None else (lambda: None)
