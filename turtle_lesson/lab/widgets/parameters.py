"""The parameters of a node, each with a control that fits it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import traitlets
from rcl_interfaces import msg, srv
from rclpy.client import Client
from rclpy.node import Node
from rclpy.parameter import Parameter, get_parameter_value, parameter_value_to_python
from rclpy.task import Future

from ...ros.idl.names import is_hidden
from ..graph import node_names
from ..words import count, enumerated, suggestion
from .backend import DISCOVERY, Link, in_a_moment
from .live_widget import LiveWidget
from .message_fields import read_list, read_number

SERVICES = {"list": "ListParameters", "describe": "DescribeParameters", "get": "GetParameters", "set": "SetParameters"}
"""What is asked of the node, and the type of each service in rcl_interfaces; its name is /node/<what>_parameters."""

BASES = ("bool", "integer", "double", "string")
TYPES = ("not set", *BASES, "byte array", *(f"{base} array" for base in BASES))
"""By number of rcl_interfaces/msg/ParameterType."""

NOT_SET, BOOL, INTEGER, DOUBLE, STRING, BYTES, BOOLS, INTEGERS, DOUBLES, STRINGS = range(10)
NUMBERS = {INTEGER: "int64", DOUBLE: "double"}
ELEMENTS: dict[int, Callable[[Any], Any]] = {BYTES: lambda number: bytes([number]), DOUBLES: float}
"""What makes an element of an array of what YAML has, where that is something else."""


@dataclass(slots=True)
class Found:
    """One parameter: what its node says of it, and what became of setting it here."""

    name: str
    value: msg.ParameterValue = field(default_factory=msg.ParameterValue)
    descriptor: msg.ParameterDescriptor = field(default_factory=msg.ParameterDescriptor)
    error: str = ""
    """Why it was not set the last time; "" if it was."""
    answers: int = 0
    """How often the node answered."""
    pending: bool = False


class ParametersPanel(LiveWidget):
    """Shows a node's parameters, sets them through the node's own services, and follows what others set."""

    SCRIPTS = ("dom", "small", "parameter_controls", "parameters")
    STYLES = ("base", "small", "parameters")
    RATE = 10.0

    node_name = traitlets.Unicode().tag(sync=True)
    items = traitlets.List(traitlets.Dict()).tag(sync=True)
    """The parameters, each with what its control needs."""
    problem = traitlets.Unicode().tag(sync=True)
    """Why there is nothing to set now; "" if there is."""
    standing = traitlets.Bool(False).tag(sync=True)
    """Whether the answer waits for robot time, which stands still."""

    def __init__(self, backend: Link, node: str) -> None:
        name = _look_up(backend.node, node)
        self._found: dict[str, Found] = {}
        self._events: Any = None
        self._clients: dict[str, Client] = {}
        self._found_by = 0.0
        self._round = 0  # of questions
        self._trouble = ""
        super().__init__(backend, node_name=name)
        self.opened()

    def opened(self) -> None:
        if not self._clients:
            node = self.backend.node
            self._events = node.create_subscription(msg.ParameterEvent, "/parameter_events", self._follow, 100)
            for name, kind in SERVICES.items():
                self._clients[name] = node.create_client(getattr(srv, kind), f"{self.node_name}/{name}_parameters")
            self._found_by = self.backend.now + DISCOVERY
        self._ask()

    def left(self) -> None:
        if self._clients:
            self._round += 1
            self.backend.node.destroy_subscription(self._events)
            self._events = None
        while self._clients:
            self.backend.node.destroy_client(self._clients.popitem()[1])

    def tick(self) -> None:
        if self._clients and self.due("node", 3):
            before, self._trouble = self._trouble, self._why_not()
            if before and not self._trouble:
                self._ask()
            self._show()

    # -- questions and answers -------------------------------------------------------------------------------------------

    def _ask(self) -> None:
        """Ask for names, descriptions and values anew."""
        self._round += 1
        turn = self._round

        def describe(answer: Any) -> None:
            names = list(answer.result.names)
            self._call("describe", lambda told: get(names, list(told.descriptors)), turn, names=names)

        def get(names: list[str], descriptors: list[Any]) -> None:
            self._call("get", lambda told: self._take(names, descriptors, list(told.values)), turn, names=names)

        self._trouble = self._why_not()
        if not self._trouble:
            self._call("list", describe, turn)
        self._show()

    def _why_not(self) -> str:
        """Why the node cannot be asked, as a sentence; "" if it can."""
        names = node_names(self.backend.node)
        if self.node_name not in names:
            others = sorted({each for each in names if not is_hidden(each)})
            return f"{self.node_name} is gone. The nodes now: {enumerated(others)}."
        if all(client.service_is_ready() for client in self._clients.values()):
            return ""
        if self.backend.clock is None and self.backend.now < self._found_by:
            return f"Looking for the services of {self.node_name}."
        return f"{self.node_name} offers no services for its parameters (start_parameter_services=False)."

    def _call(self, what: str, take: Callable[[Any], object], turn: int | None = None, **content: Any) -> Future:
        """Call one of the services; `take` is given the answer, unless it is one to an older round of questions (`turn`)."""

        def answered(future: Future) -> None:
            if turn not in (None, self._round):
                return
            try:
                take(future.result())
            except Exception as error:
                self._trouble = f"{self.node_name} could not be asked: {error}"
            self._show()

        client = self._clients[what]
        future = client.call_async(client.srv_type.Request(**content))
        future.add_done_callback(answered)
        return future

    def _take(self, names: list[str], descriptors: list[Any], values: list[Any]) -> None:
        """One that is not set makes some nodes give no value at all; then every value counts as not set."""
        values += [msg.ParameterValue()] * (len(names) - len(values))
        descriptors += [msg.ParameterDescriptor()] * (len(names) - len(descriptors))
        self._found = {name: self._found.get(name) or Found(name) for name in names}
        for found, value, descriptor in zip(self._found.values(), values, descriptors, strict=True):
            found.value, found.descriptor = value, descriptor

    def _follow(self, event: Any) -> None:
        if event.node != self.node_name:
            return
        for parameter in event.changed_parameters:
            if found := self._found.get(parameter.name):
                found.value = parameter.value
        if event.deleted_parameters or any(parameter.name not in self._found for parameter in event.new_parameters):
            self._ask()  # for a new one there is a description, too
        self._show()

    # -- orders ----------------------------------------------------------------------------------------------------------

    def do_set(self, name: str, value: Any) -> None:
        """Have the node set a parameter to what was typed (true or false, for a checkbox).

        Where robot time stands still, a moment of it passes, so that the node can answer.
        """
        found = self._found.get(name)
        if found is None:
            raise ValueError(f"{self.node_name} has no parameter {name!r}.")
        self._trouble = self._why_not()
        try:
            wanted = read_parameter(value, found.value.type or found.descriptor.type, found.descriptor.dynamic_typing)
            if self._trouble:
                raise ValueError(self._trouble)
        except (TypeError, ValueError) as error:
            self._told(found, f"Not asked: {error}")
            return

        def told(answer: Any) -> None:
            (result,) = answer.results
            if result.successful:
                found.value = wanted
            self._told(found, "" if result.successful else f"Refused: {result.reason or 'refused, without a reason'}")

        found.pending = True
        future = self._call("set", told, parameters=[msg.Parameter(name=name, value=wanted)])
        in_a_moment(self.backend, future.done)
        if found.pending:
            self.words = f"Asked {self.node_name} to set {name}; its answer comes once robot time passes."
        self._show()

    def do_ask(self) -> None:
        """Ask the node for all its parameters anew, and let a moment of robot time pass if it stands still."""
        self._ask()
        in_a_moment(self.backend, lambda: bool(self._found or self._trouble))
        self._show()

    def _told(self, found: Found, trouble: str) -> None:
        """The node has answered, or was not asked: `trouble` says why nothing changed, "" if it did."""
        found.pending, found.error = False, trouble
        found.answers += 1
        now = shown_parameter(found.value)
        self.words = f"{found.name} stays {now}. {trouble}" if trouble else f"{found.name} is {now} now."
        self._show()

    # -- what is shown ---------------------------------------------------------------------------------------------------

    def _show(self) -> None:
        clock, waits = self.backend.clock, not self._found and not self._trouble
        with self.hold_sync():
            self.items = [_item(found) for found in self._found.values()]
            self.problem = f"Asked {self.node_name}; it answers once robot time passes." if waits else self._trouble
            self.standing = waits and clock is not None and not clock.playing

    def _text(self) -> str:
        if self.problem:
            return f"Parameters of {self.node_name}: {self.problem}"
        found = [f"{each.name} = {shown_parameter(each.value)}" for each in self._found.values()]
        return f"{self.node_name} has {count(len(found), 'parameter')}: {', '.join(found)}."


def _item(found: Found) -> dict[str, Any]:
    descriptor, kind, shown = found.descriptor, found.value.type, shown_parameter(found.value)
    ranges = {INTEGER: descriptor.integer_range, DOUBLE: descriptor.floating_point_range}
    limits = [{"low": each.from_value, "high": each.to_value, "step": each.step} for each in ranges.get(kind, ())]
    control = "number" if kind in ranges else "text"
    if kind == BOOL and not descriptor.dynamic_typing:
        control = "checkbox"
    elif limits and 0 < limits[0]["high"] - limits[0]["low"] < 1e15:
        control = "slider"
    item = {
        "name": found.name,
        "type": TYPES[kind],
        "control": control,
        "value": found.value.bool_value if kind == BOOL else shown,
        "help": " ".join(filter(None, (descriptor.description, descriptor.additional_constraints))),
        "error": found.error,
        "pending": found.pending,
        "answers": found.answers,
        "locked": "read-only: its node sets it when it starts" if descriptor.read_only else "",
    }
    return item | (limits[0] if limits else {})


def _look_up(node: Node, name: str) -> str:
    """The full name of a node that is there. Raises ValueError with what was meant perhaps."""
    if not isinstance(name, str) or not name:
        raise ValueError(f'a node is named by its name, such as "/navigator", got {name!r}')
    full = name if name.startswith("/") else f"/{name}"
    names = node_names(node)
    if full in names:
        return full
    visible = sorted({each for each in names if not is_hidden(each)})
    raise ValueError(f'there is no node called "{name}" now. {suggestion(full, visible)}')


# -- values --------------------------------------------------------------------------------------------------------------


def shown_parameter(value: msg.ParameterValue) -> str:
    """A value as it stands in a field: YAML for arrays, bytes as numbers; nothing if it is not set."""
    found = parameter_value_to_python(value)
    if value.type >= BYTES:
        import yaml

        rows = [each[0] for each in found] if value.type == BYTES else list(found)
        return yaml.safe_dump(rows, default_flow_style=True, width=float("inf"), allow_unicode=True).strip()
    return "" if found is None else found if isinstance(found, str) else repr(found)


def read_parameter(typed: Any, kind: int, dynamic: bool = False) -> Any:
    """An rcl_interfaces/msg/ParameterValue from what was typed. Raises TypeError or ValueError for what it cannot be.

    `kind` is the number of the type; a dynamically typed parameter, and one that is not set, takes what YAML makes of it.
    """
    if dynamic or kind == NOT_SET:
        return get_parameter_value(str(typed))
    if kind in NUMBERS:
        typed = read_number(str(typed), NUMBERS[kind])
    elif kind >= BYTES:
        typed = [ELEMENTS.get(kind, lambda each: each)(each) for each in read_list(str(typed))]
    return Parameter("", Parameter.Type(kind), typed).get_parameter_value()
