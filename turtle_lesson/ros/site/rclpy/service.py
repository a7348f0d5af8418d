"""Services: the side that answers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from turtle_lesson.ros.idl import checks
from turtle_lesson.ros.rmw.service import ServerEnd

from ._entity import SERVICE, Entity
from .callback_groups import CallbackGroup
from .qos import QoSProfile


class Service(Entity):
    """Made by `Node.create_service`. The callback gets the request and a fresh response, and returns the response."""

    _kind = SERVICE

    def __init__(
        self,
        server: ServerEnd,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
    ) -> None:
        super().__init__(callback, callback_group)
        self._server = server
        self._answers = True
        server.wake = self._signal
        self.srv_type = srv_type
        self._response_type = srv_type.Response
        self.srv_name = srv_name
        self.qos_profile = qos_profile
        self._asking: dict[int, Any] = {}

    def __repr__(self) -> str:
        return f"<Service {self.srv_name}>"

    @property
    def service_name(self) -> str:
        """The service's full name."""
        return self._server.name

    def _has_work(self) -> bool:
        return bool(self._server.queue)

    def _take(self) -> tuple[Any, ...]:
        queue = self._server.queue
        request = queue.pop(0)
        if queue:
            self._signal()
        message = request.message
        self._asking[id(message)] = request
        return (message, self._response_type())

    def _done_with(self, arguments: tuple[Any, ...], result: Any) -> None:
        # A program may have put a function of its own in place of `send_response`, to answer later.
        self.send_response(result, self._asking.pop(id(arguments[0])))

    def send_response(self, response: Any, header: Any) -> None:
        """Answer a request: `header` tells which one (what rclpy hands over when a callback has returned)."""
        if not isinstance(response, self._response_type):
            raise TypeError(
                f"the callback of {self.service_name} returned {response!r}, where {self.srv_type.__name__}.Response is "
                "expected: end it with `return response`"
            )
        header.client.reply(header.number, response if checks.when_assigned else checks.sendable(response))

    def destroy(self) -> None:
        """Stop offering the service."""
        if not self._destroyed:
            super().destroy()
            self._server.node.process.world.graph.remove_service_end(self._server)
