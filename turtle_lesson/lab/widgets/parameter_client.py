"""The parameters of another node, asked for and set through its services, and followed as others change them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from .backend import Backend
from .lazy_endpoints import DISCOVERY, in_a_moment
from .parameter_values import to_python

SERVICES = {
    "list": "ListParameters",
    "describe": "DescribeParameters",
    "get": "GetParameters",
    "set": "SetParameters",
}
"""What is asked of the node, and the type of each service in rcl_interfaces; its name is /node/<what>_parameters."""


@dataclass(slots=True)
class Found:
    """One parameter: its name, its value (None if it is not set), and what its node says of it."""

    name: str
    value: Any
    type: int
    """The number of its type, as rcl_interfaces/msg/ParameterType has it; 0 if it is not set."""
    descriptor: Any


class ParameterDesk:
    """Asks a node. `changed()` is called with all news; nothing here waits."""

    def __init__(self, backend: Backend, node_name: str, changed: Callable[[], object]) -> None:
        self._backend, self._node_name, self._changed = backend, node_name, changed
        self._clients: dict[str, Any] = {}
        self._events: Any = None
        self._asked = 0
        self._found_by = 0.0
        self.found: dict[str, Found] = {}
        self.known = False
        """Whether the node has answered what parameters it has."""
        self.problem = ""
        """Why it could not be asked, as a sentence."""

    @property
    def is_there(self) -> bool:
        """Whether the graph shows the node."""
        return self._node_name in node_names(self._backend.node)

    # -- asking -----------------------------------------------------------------------------------------------------

    def listen(self) -> None:
        """Ask for everything, and follow /parameter_events from now on."""
        from rcl_interfaces.msg import ParameterEvent

        if self._events is None:
            node = self._backend.node
            self._events = node.create_subscription(ParameterEvent, "/parameter_events", self._hear, 100)
        for what in SERVICES:
            self._client(what)  # now, since on a real network a client finds no server in its first moments
        self._found_by = self._backend.now + DISCOVERY
        self.ask()

    def close(self) -> None:
        """Ask and listen no more."""
        node = self._backend.node
        if self._events is not None:
            node.destroy_subscription(self._events)
            self._events = None
        for client in self._clients.values():
            node.destroy_client(client)
        self._clients.clear()
        self._asked += 1

    def ask(self) -> None:
        """Ask for names, descriptions and values anew."""
        self._asked += 1
        turn = self._asked

        def listed(answer: Any) -> None:
            names = list(answer.result.names)
            self._call("describe", {"names": names}, lambda described: described_(names, described), turn)

        def described_(names: list[str], answer: Any) -> None:
            descriptors = list(answer.descriptors)
            self._call("get", {"names": names}, lambda got: self._take(names, descriptors, list(got.values)), turn)

        self._call("list", {}, listed, turn)

    def _take(self, names: list[str], descriptors: list[Any], values: list[Any]) -> None:
        """One that is not set makes some nodes give no value at all; then every value counts as not set."""
        from rcl_interfaces.msg import ParameterDescriptor, ParameterValue

        values += [ParameterValue()] * (len(names) - len(values))
        descriptors += [ParameterDescriptor()] * (len(names) - len(descriptors))
        self.found = {
            name: Found(name, to_python(value), value.type, descriptor)
            for name, descriptor, value in zip(names, descriptors, values, strict=True)
        }
        self.known, self.problem = True, ""
        self._changed()

    # -- setting ----------------------------------------------------------------------------------------------------

    def set(self, name: str, value: Any, told: Callable[[str], object]) -> None:
        """Ask the node to set a parameter. `told` hears why it refused, in its own words, or "".

        Raises ValueError for a value that no parameter can have. Where robot time stands still, a moment of it passes.
        """
        from rcl_interfaces.msg import Parameter

        message = Parameter(name=name, value=value)

        def answered(answer: Any) -> None:
            result = answer.results[0] if answer.results else None
            if result is not None and result.successful:
                self.found[name].value, self.found[name].type = to_python(value), value.type
                told("")
            else:
                told((result.reason if result else "") or "refused, without a reason")

        future = self._call("set", {"parameters": [message]}, answered, None)
        if future is None:
            told(self.problem)
        else:
            in_a_moment(self._backend, future)

    def ask_in_a_moment(self) -> None:
        """Ask now, and let a moment of robot time pass if it stands still."""
        self.ask()
        clock = self._backend.clock
        for _ in range(10):
            if self.known or self.problem or clock is None or clock.playing:
                return
            clock.step(0.005)

    # -- the machinery ----------------------------------------------------------------------------------------------

    def _call(self, what: str, content: dict[str, Any], then: Callable[[Any], object], turn: int | None) -> Any:
        """Call one of the node's services; an answer to an older round of questions (`turn`) is dropped."""
        client = self._client(what)
        if not client.service_is_ready():
            self.problem = self._why_not()
            self._changed()
            return None
        self.problem = ""

        def answered(future: Any) -> None:
            if self._backend.ended or (turn is not None and turn != self._asked):
                return
            try:
                then(future.result())
            except Exception as error:
                self.problem = f"{self._node_name} could not be asked: {error}"
                self._changed()

        future = client.call_async(client.srv_type.Request(**content))
        future.add_done_callback(lambda done: self._backend.loop.now_or_soon(answered, done))
        return future

    def _client(self, what: str) -> Any:
        if what not in self._clients:
            from rcl_interfaces import srv

            kind = getattr(srv, SERVICES[what])
            self._clients[what] = self._backend.node.create_client(kind, f"{self._node_name}/{what}_parameters")
        return self._clients[what]

    def _why_not(self) -> str:
        if self._backend.clock is None and self._backend.now < self._found_by:
            return f"Looking for the services of {self._node_name}."
        if not self.is_there:
            return f"{self._node_name} is gone."
        return f"{self._node_name} offers no services for its parameters (start_parameter_services=False)."

    def _hear(self, event: Any) -> None:
        if event.node == self._node_name:
            self._backend.loop.now_or_soon(self._follow, event)

    def _follow(self, event: Any) -> None:
        if self._events is None or self._backend.ended:
            return
        for parameter in event.changed_parameters:
            found = self.found.get(parameter.name)
            if found is not None:
                found.value, found.type = to_python(parameter.value), parameter.value.type
        for parameter in event.deleted_parameters:
            self.found.pop(parameter.name, None)
        if any(parameter.name not in self.found for parameter in event.new_parameters):
            self.ask()  # for a new one there is a description, too
        self._changed()


def node_names(node: Any) -> list[str]:
    """The full names of all nodes in the graph, sorted."""
    names = node.get_node_names_and_namespaces()
    return sorted({f"{namespace.rstrip('/')}/{name}" for name, namespace in names})
