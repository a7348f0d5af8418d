"""Services: a client's request goes to every server of that name, the first answer comes back to that client alone."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from .topic import latency_of, nobody

if TYPE_CHECKING:
    from ..core import Simulation
    from ..trace import Call, Trace
    from .graph import NodeEntry


class Request(NamedTuple):
    """A request on its way: who asked, the number it has there, and the message."""

    client: ClientEnd
    number: int
    message: Any
    call: Call | None = None


class ServerEnd:
    """A service's end in its node: requests that have arrived, oldest first."""

    def __init__(self, node: NodeEntry, name: str, type_name: str) -> None:
        self.node = node
        self.name = name
        self.type_name = type_name
        self.queue: deque[Request] = deque()
        self.wake: Callable[[], object] = nobody

    def receive(self, request: Request) -> None:
        """A request arrives."""
        if request.call is not None:
            request.client.trace.received(request.call, self.node)  # type: ignore[union-attr]
        self.queue.append(request)
        self.wake()


class ClientEnd:
    """A client's end: answers that have arrived, as (number of the request, response)."""

    def __init__(self, node: NodeEntry, name: str, type_name: str, simulation: Simulation) -> None:
        self.node = node
        self.name = name
        self.type_name = type_name
        self.queue: deque[tuple[int, Any]] = deque()
        self.wake: Callable[[], object] = nobody
        self.simulation = simulation
        self.latency = latency_of(name)
        self._sent = 0
        self.trace: Trace | None = None
        self._calls: dict[int, Call] = {}

    def ask(self, servers: list[ServerEnd], message: Any) -> int:
        """Send a request to the servers; returns its number, by which the answer will be known."""
        self._sent += 1
        arrival = self.simulation.now + self.latency
        call = None
        if self.trace is not None:
            call = self._calls[self._sent] = self.trace.asked(self, message._wire_copy())
        for server in servers:
            self.simulation.at(arrival, server.receive, Request(self, self._sent, message._wire_copy(), call))
        return self._sent

    def reply(self, number: int, message: Any) -> None:
        """Send an answer back to this client."""
        arrival = self.simulation.now + self.latency
        if self.trace is not None and number in self._calls:
            self.trace.answered(self._calls[number], message._wire_copy())
        self.simulation.at(arrival, self._receive, (number, message._wire_copy()))

    def _receive(self, answer: tuple[int, Any]) -> None:
        if self.trace is not None and (call := self._calls.pop(answer[0], None)) is not None:
            self.trace.told(call)
        self.queue.append(answer)
        self.wake()
