"""The parameters of another node: asked for and set through its services, followed, and their values as they are typed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from .backend import Backend
from .lazy_endpoints import DISCOVERY, in_a_moment

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


class ParameterClient:
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

    def listen(self) -> None:
        """Ask for everything, and follow /parameter_events from now on."""
        from rcl_interfaces.msg import ParameterEvent

        if self._events is None:
            node = self._backend.node
            self._events = node.create_subscription(ParameterEvent, "/parameter_events", self._follow, 100)
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

        def describe(answer: Any) -> None:
            names = list(answer.result.names)
            self._call("describe", {"names": names}, lambda answer: get(names, list(answer.descriptors)), turn)

        def get(names: list[str], descriptors: list[Any]) -> None:
            self._call("get", {"names": names}, lambda got: self._take(names, descriptors, list(got.values)), turn)

        self._call("list", {}, describe, turn)

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
            in_a_moment(self._backend, future.done)

    def ask_in_a_moment(self) -> None:
        """Ask now, and let a moment of robot time pass if it stands still."""
        self.ask()
        in_a_moment(self._backend, lambda: bool(self.known or self.problem))

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
        future.add_done_callback(answered)
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

    def _follow(self, event: Any) -> None:
        if event.node != self._node_name:
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


# -- values ---------------------------------------------------------------------------------------------------------

ARRAYS = ("byte array", "bool array", "integer array", "double array", "string array")
TYPES = ("not set", "bool", "integer", "double", "string", *ARRAYS)
"""By number of rcl_interfaces/msg/ParameterType."""

NOT_SET, BOOL, INTEGER, DOUBLE, STRING, BYTES, BOOLS, INTEGERS, DOUBLES, STRINGS = range(10)
_ELEMENTS = {BYTES: int, BOOLS: bool, INTEGERS: int, DOUBLES: float, STRINGS: str}
_WORDS = {int: "whole numbers", bool: "true and false", float: "numbers", str: "texts"}
_LARGEST = 2**63


def to_python(value: Any) -> Any:
    """What an rcl_interfaces/msg/ParameterValue holds; None if it is not set."""
    if not NOT_SET < value.type < len(TYPES):
        return None
    found = getattr(value, _field(value.type))
    return [each[0] if isinstance(each, bytes) else each for each in found] if value.type >= BYTES else found


def _field(kind: int) -> str:
    return f"{TYPES[kind].replace(' ', '_')}_value"


def shown(value: Any) -> str:
    """A value as it stands in a field: YAML for arrays."""
    if value is None:
        return ""
    if isinstance(value, list):
        import yaml

        return yaml.safe_dump(value, default_flow_style=True, width=float("inf"), allow_unicode=True).strip()
    return value if isinstance(value, str) else repr(value)


def read(typed: Any, kind: int, dynamic: bool = False) -> Any:
    """An rcl_interfaces/msg/ParameterValue from what was typed. Raises ValueError, in words, for what it cannot be.

    `kind` is the number of the type; a dynamically typed parameter, and one that is not set, takes what YAML makes of it.
    """
    from rcl_interfaces.msg import ParameterValue

    if dynamic or kind == NOT_SET:
        value, kind = _guessed(typed)
    else:
        value = _converted(typed, kind)
    message = ParameterValue(type=kind)
    setattr(message, _field(kind), [bytes([each]) for each in value] if kind == BYTES else value)
    return message


def _converted(typed: Any, kind: int) -> Any:
    text = str(typed).strip().replace("−", "-")
    if kind == BOOL:
        if not isinstance(typed, bool):
            raise ValueError(f"expected true or false, got {typed!r}")
        return typed
    if kind == INTEGER:
        try:
            value = int(text)
        except ValueError:
            raise ValueError(f'expected a whole number, got "{text}"') from None
        if not -_LARGEST <= value < _LARGEST:
            raise ValueError("expected a whole number of 64 bits, and this one is larger")
        return value
    if kind == DOUBLE:
        try:
            return float(text)
        except ValueError:
            hint = ": write a point, not a comma" if "," in text else ""
            raise ValueError(f'expected a number, got "{text}"{hint}') from None
    return str(typed) if kind == STRING else _array(_yaml(str(typed)), _ELEMENTS[kind])


def _array(value: Any, element: type) -> list[Any]:
    if not isinstance(value, list):
        raise ValueError(f"a list of {_WORDS[element]} is expected, such as [{'a, b' if element is str else '1, 2'}]")
    made = [float(each) if element is float and type(each) is int else each for each in value]
    for each in made:
        if type(each) is not element:
            raise ValueError(f"a list of {_WORDS[element]} is expected, and {each!r} is none")
    return made


def _guessed(typed: Any) -> tuple[Any, int]:
    """A value of any type, and which: as `ros2 param set` reads it."""
    value = typed if isinstance(typed, bool) else _yaml(str(typed))
    for element, kind in ((bool, BOOL), (int, INTEGER), (float, DOUBLE)):
        if type(value) is element:
            return value, kind
    for kind in (BOOLS, INTEGERS, DOUBLES, STRINGS):
        if isinstance(value, list) and all(type(each) is _ELEMENTS[kind] for each in value):
            return value, kind
    return str(typed), STRING


def _yaml(text: str) -> Any:
    import yaml

    from ...ros.runtime.files import safe_load

    try:
        return safe_load(text)
    except yaml.YAMLError:
        raise ValueError(f'"{text}" is not valid YAML: lists are written [1, 2, 3]') from None
