"""The parameters of a node, each with a control that fits it."""

from __future__ import annotations

from typing import Any

import traitlets

from ...ros.idl.names import is_hidden
from ..words import count, did_you_mean, enumerated
from .backend import Backend
from .live_widget import LiveWidget
from .parameter_client import BOOL, DOUBLE, INTEGER, TYPES, Found, ParameterClient, node_names, read, shown


class ParametersPanel(LiveWidget):
    """Shows a node's parameters, sets them through the node's own service, and follows what others set."""

    SCRIPTS = ("dom", "small", "parameter_controls", "parameters")
    STYLES = ("base", "small", "parameters")

    node_name = traitlets.Unicode().tag(sync=True)
    items = traitlets.List(traitlets.Dict()).tag(sync=True)
    """The parameters, each with what its control needs."""
    problem = traitlets.Unicode().tag(sync=True)
    """Why there is nothing to set now; "" if there is."""
    standing = traitlets.Bool(False).tag(sync=True)
    """Whether the answer waits for robot time, which stands still."""

    def __init__(self, backend: Backend, node: str) -> None:
        name = _look_up(backend.node, node)
        self._client = ParameterClient(backend, name, self._show)
        self._errors: dict[str, str] = {}
        self._answers: dict[str, int] = {}
        self._pending: set[str] = set()
        self._there = True
        super().__init__(backend, node_name=name)
        self._client.listen()
        self._show()

    def do_set(self, name: str, value: Any) -> None:
        """Have the node set a parameter to what was typed (true or false, for a checkbox)."""
        found = self._client.found.get(name)
        if found is None:
            raise ValueError(f"{self.node_name} has no parameter {name!r}.")
        try:
            wanted = read(value, found.type or found.descriptor.type, found.descriptor.dynamic_typing)
        except ValueError as error:
            self._told(name, f"Not asked: {error}")
            return
        self._pending.add(name)
        self._client.set(name, wanted, lambda reason: self._told(name, reason and f"Refused: {reason}"))
        if name in self._pending:
            self.words = f"Asked {self.node_name} to set {name}; its answer comes once robot time passes."
        self._show()

    def do_ask(self) -> None:
        """Ask the node for all its parameters anew."""
        self._client.ask_in_a_moment()
        self._show()

    def _told(self, name: str, trouble: str) -> None:
        """The node has answered, or was not asked: `trouble` says why nothing changed, "" if it did."""
        self._pending.discard(name)
        self._answers[name] = self._answers.get(name, 0) + 1
        found = self._client.found.get(name)
        now = shown(found.value) if found is not None else "gone"
        self._errors.pop(name, None)
        if trouble:
            self._errors[name] = trouble
        self.words = f"{name} stays {now}. {trouble}" if trouble else f"{name} is {now} now."
        self._show()

    def tick(self) -> None:
        """See whether the node is still there, and ask again when it has come back."""
        if not self.due("node", 3):
            return
        there = self._client.is_there
        if there and (not self._there or (self._client.problem and not self._client.known)):
            self._client.ask()
        self._there = there
        self._show()

    def opened(self) -> None:
        self._client.listen()

    def left(self) -> None:
        self._client.close()

    def _show(self) -> None:
        clock = self.backend.clock
        with self.hold_sync():
            self.items = [self._item(found) for found in self._client.found.values()]
            self.problem = self._why_nothing()
            self.standing = bool(self.problem) and self._there and clock is not None and not clock.playing

    def _why_nothing(self) -> str:
        if not self._there:
            others = [each for each in node_names(self.backend.node) if not is_hidden(each)]
            return f"{self.node_name} is gone. The nodes now: {enumerated(others)}."
        if self._client.problem:
            return self._client.problem
        if not self._client.known:
            return f"Asked {self.node_name}; it answers once robot time passes."
        return "" if self._client.found else f"{self.node_name} has no parameters."

    def _item(self, found: Found) -> dict[str, Any]:
        descriptor = found.descriptor
        limits = _limits(found)
        item = {
            "name": found.name,
            "type": TYPES[found.type],
            "control": _control(found, limits),
            "value": found.value if isinstance(found.value, bool) else shown(found.value),
            "help": " ".join(filter(None, (descriptor.description, descriptor.additional_constraints))),
            "error": self._errors.get(found.name, ""),
            "pending": found.name in self._pending,
            "answers": self._answers.get(found.name, 0),
            "locked": "read-only: its node sets it when it starts" if descriptor.read_only else "",
        }
        return {**item, **limits}

    def text(self) -> str:
        """All parameters with their values."""
        problem = self._why_nothing()
        if problem:
            return f"Parameters of {self.node_name}: {problem}"
        found = [f"{each.name} = {shown(each.value)}" for each in self._client.found.values()]
        return f"{self.node_name} has {count(len(found), 'parameter')}: {', '.join(found)}."


def _limits(found: Found) -> dict[str, float]:
    """Lowest, highest and step that the node allows, if it says so."""
    ranges = {INTEGER: found.descriptor.integer_range, DOUBLE: found.descriptor.floating_point_range}
    for each in ranges.get(found.type, ()):
        return {"low": each.from_value, "high": each.to_value, "step": each.step}
    return {}


def _control(found: Found, limits: dict[str, float]) -> str:
    if found.type == BOOL and not found.descriptor.dynamic_typing:
        return "checkbox"
    if limits and limits["high"] > limits["low"] and abs(limits["high"] - limits["low"]) < 1e15:
        return "slider"
    return "number" if found.type in (INTEGER, DOUBLE) else "text"


def _look_up(node: Any, name: str) -> str:
    """The full name of a node that is there. Raises ValueError with what was meant perhaps."""
    if not isinstance(name, str) or not name:
        raise ValueError(f'a node is named by its name, such as "/navigator", got {name!r}')
    full = name if name.startswith("/") else f"/{name}"
    names = node_names(node)
    if full in names:
        return full
    visible = [each for each in names if not is_hidden(each)]
    hint = did_you_mean(full, visible) or f"The nodes: {enumerated(visible)}."
    raise ValueError(f'there is no node called "{name}" now. {hint}')
