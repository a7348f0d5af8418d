"""Services: a client's request goes to every server of that name, the first answer comes back to that client alone."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .transport import ReliableLine, latency_of, nobody

if TYPE_CHECKING:
    from ..sim.simulation import Simulation
    from .graph import NodeEntry
    from .network import Conditions, Network
    from .trace import Call, Trace


@dataclass(slots=True, eq=False)
class Request:
    """A request on its way: its client, the number it has there, the message, and what a trace keeps of the call."""

    client: ClientEnd
    number: int
    message: Any
    call: Call | None

    def answer(self, message: Any) -> None:
        """Send the answer to the client that asked."""
        self.client.reply(self.number, message)


class ServerEnd:
    """A service's end in its node: requests that have arrived, oldest first."""

    def __init__(self, node: NodeEntry, name: str, type_name: str) -> None:
        self.node = node
        self.name = name
        self.type_name = type_name
        self.queue: list[Request] = []  # it is nearly always empty, and an empty deque takes half a kB
        self.arrivals: deque[int] | None = None
        """When each request that waits has come (ns), where a trace is kept."""
        self.wake: Callable[[], object] = nobody

    def receive(self, request: Request) -> None:
        """A request arrives."""
        if request.call is not None:
            request.client.trace.received(request.call, self.node)  # type: ignore[union-attr]
        self.queue.append(request)
        if self.arrivals is not None:
            self.arrivals.append(request.client.simulation.now)
        self.wake()


class ClientEnd:
    """A client's end: answers that have arrived, as (number of the request, response).

    `offered` are the services of this name, of any type; the graph keeps the list.
    """

    def __init__(
        self,
        node: NodeEntry,
        name: str,
        type_name: str,
        offered: list[ServerEnd],
        simulation: Simulation,
        network: Network,
    ) -> None:
        self.node = node
        self.offered = offered
        self.name = name
        self.type_name = type_name
        self.queue: deque[tuple[int, Any]] = deque()
        self.wake: Callable[[], object] = nobody
        self.simulation = simulation
        self.latency = latency_of(name)
        self._network = network
        self._lines: dict[Callable[[Any], object], ReliableLine] | None = None
        self.use(network.of(name))
        self._sent = 0
        self.trace: Trace | None = None
        self._calls: dict[int, Call] = {}

    def ask(self, message: Any) -> int:
        """Send a request to all servers; returns its number, by which the answer will be known."""
        self._sent = number = self._sent + 1
        simulation, call = self.simulation, None
        if self.trace is not None:
            call = self._calls[number] = self.trace.asked(self, message._wire_copy())
        for server in self.offered:
            if server.type_name == self.type_name:
                request = Request(self, number, message._wire_copy(), call)
                if self._lines is None:
                    simulation.at(simulation.now + self.latency, server.receive, request)
                else:
                    self._line_to(server.receive, server.node).send(request, simulation.now)
        return number

    def reply(self, number: int, message: Any) -> None:
        """Send an answer back to this client."""
        simulation = self.simulation
        if self.trace is not None and number in self._calls:
            self.trace.answered(self._calls[number], message._wire_copy())
        answer = (number, message._wire_copy())
        if self._lines is None:
            simulation.at(simulation.now + self.latency, self._receive, answer)
        else:
            self._line_to(self._receive, self.node).send(answer, simulation.now)

    def use(self, conditions: Conditions | None) -> None:
        """Have requests and answers travel under these conditions from now on; None for the usual ones.

        Services are reliable, and keep everything: what is lost is sent again until it has arrived.
        """
        if conditions is not None and self._lines is None:
            self._lines = {}
        for line in (self._lines or {}).values():
            line.use(conditions)

    @property
    def cut_off(self) -> bool:
        """Whether nothing comes through."""
        conditions = self._network.of(self.name)
        return conditions is not None and conditions.loss >= 1

    def _line_to(self, receive: Callable[[Any], object], node: NodeEntry) -> ReliableLine:
        """The way of requests to a server, or of answers to this client, in a network that is not the usual one."""
        assert self._lines is not None
        line = self._lines.get(receive)
        if line is None:

            def deliver(wire: Any, _: int) -> None:
                receive(wire)

            ends = f"{self.name} {self.node.full_name} {node.full_name}"
            line = ReliableLine(self.simulation, self.latency, deliver, nobody, self._network, ends)
            line.use(self._network.of(self.name))
            self._lines[receive] = line
        return line

    def _receive(self, answer: tuple[int, Any]) -> None:
        if self.trace is not None and (call := self._calls.pop(answer[0], None)) is not None:
            self.trace.told(call)
        self.queue.append(answer)
        self.wake()
