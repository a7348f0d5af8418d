"""Services: a client's request goes to every server of that name, the first answer comes back to that client alone."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from .topic import latency_of, nobody

if TYPE_CHECKING:
    from ..core import Simulation
    from .graph import NodeEntry


class Request(NamedTuple):
    """A request on its way: who asked, the number it has there, and the message."""

    client: ClientEnd
    number: int
    message: Any


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

    def ask(self, servers: list[ServerEnd], message: Any) -> int:
        """Send a request to the servers; returns its number, by which the answer will be known."""
        self._sent += 1
        arrival = self.simulation.now + self.latency
        for server in servers:
            self.simulation.at(arrival, server.receive, Request(self, self._sent, message._wire_copy()))
        return self._sent

    def reply(self, number: int, message: Any) -> None:
        """Send an answer back to this client."""
        arrival = self.simulation.now + self.latency
        self.simulation.at(arrival, self._receive, (number, message._wire_copy()))

    def _receive(self, answer: tuple[int, Any]) -> None:
        self.queue.append(answer)
        self.wake()
