"""Asking a service, one question at a time, and what became of it in words."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..words import number
from .message_types import plain
from .station import Station

Answered = Callable[[str, str], object]
"""Called with what became of a question: in words, and the answer in YAML ("" where none came)."""

DISCOVERY = 2.0
"""Seconds for which a question is held back on a real network, until a new client has found who answers it."""

LONGEST_LIST = 50
"""How many elements of an array are shown of an answer."""


class Caller:
    """Calls one service, as any client would. Until the first question nothing of it is to be seen in the graph."""

    def __init__(self, station: Station, service_class: Any, name: str) -> None:
        self._station, self._class, self._name = station, service_class, name
        self._client: Any = None
        self._future: Any = None
        self._held: Any = None
        self._deadline = self._asked = 0.0
        self._answered: Answered = lambda words, answer: None

    @property
    def asking(self) -> bool:
        """Whether it waits for an answer."""
        return self._future is not None or self._held is not None

    def ask(self, request: Any, timeout: float, answered: Answered) -> None:
        """Ask; `answered` hears what came, at the latest after `timeout` s of robot time."""
        if self.asking:
            raise ValueError(f"{self._name} has not answered the last request yet: wait, or stop waiting.")
        self._answered = answered
        if self._client is None:
            self._client = self._station.node.create_client(self._class, self._name)
        self._asked, self._deadline = self._station.now, self._station.now + timeout
        if self._client.service_is_ready():
            self._send(request)
        elif self._station.clock is None:  # a real network, where a client finds no server in its first moments
            self._held = request
        else:
            self._end(f"Not asked: {self.why_unheard()}", "")

    def look(self) -> None:
        """See whether the answer is overdue, or can never come."""
        if not self.asking:
            return
        if self._held is not None:
            self._look_again()
        elif self._station.now > self._deadline:
            waited = number(self._deadline - self._asked, 1)
            self._end(f"No answer from {self._name} within {waited} s of robot time.", "")
        elif not self._is_offered():
            self._end(f"No answer: the node that offered {self._name} is gone.", "")

    def give_up(self) -> None:
        """Wait no more."""
        future, self._future, self._held = self._future, None, None
        if future is not None and self._client is not None:
            self._client.remove_pending_request(future)

    def close(self) -> None:
        """Ask no more."""
        self.give_up()
        if self._client is not None:
            self._station.node.destroy_client(self._client)
            self._client = None

    def why_unheard(self) -> str:
        """A sentence that says why no node would answer; "" if one would."""
        return "" if self._is_offered() else f"No node offers {self._name} now."

    def _is_offered(self) -> bool:
        """Looks at the graph alone where nothing was asked yet, so that looking leaves no client there."""
        if self._client is not None and self._held is None:
            return self._client.service_is_ready()
        return any(self._name == name for name, _ in self._station.node.get_service_names_and_types())

    def _send(self, request: Any) -> None:
        self._future = future = self._client.call_async(request)
        future.add_done_callback(lambda done: self._station.loop.now_or_soon(self._done, done))

    def _look_again(self) -> None:
        """Send the question that was held back, if there is somebody now."""
        request = self._held
        if self._client.service_is_ready():
            self._held = None
            self._send(request)
        elif self._station.now - self._asked > DISCOVERY:
            self._held = None
            self._end(f"Not asked: {self.why_unheard()}", "")

    def _done(self, future: Any) -> None:
        if future is not self._future:
            return
        try:
            response = future.result()
        except Exception as error:
            self._end(f"The call failed: {error}", "")
            return
        seconds = number(self._station.now - self._asked)
        self._end(f"{self._name} answered after {seconds} s of robot time.", in_yaml(response))

    def _end(self, words: str, answer: str) -> None:
        self.give_up()
        self._answered(words, answer)


def in_yaml(message: Any) -> str:
    """A message in lines as `ros2 topic echo` shows it; of a long array the first elements."""
    import yaml

    fields = _shortened(plain(message))
    if not fields:
        return "(the answer has no fields)"
    return yaml.safe_dump(fields, sort_keys=False, allow_unicode=True, default_flow_style=False).strip()


def _shortened(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _shortened(each) for name, each in value.items()}
    if isinstance(value, list):
        rest = [f"… and {len(value) - LONGEST_LIST} more"] if len(value) > LONGEST_LIST else []
        return [*map(_shortened, value[:LONGEST_LIST]), *rest]
    return value
