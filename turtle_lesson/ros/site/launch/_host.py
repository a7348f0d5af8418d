"""What actions need from whatever carries a launch out (here `turtle_lesson.ros.launching`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from .actions.execute_local import ExecuteLocal


class RosHelper(Protocol):
    """A node of launch's own, which listens to managed nodes and calls their services."""

    def watch(self, node_name: str, heard: Callable[[Any], None]) -> None:
        """Have a function called with each TransitionEvent of a node."""

    def change_state(self, node_name: str, transition_id: int, answered: Callable[[bool], None]) -> None:
        """Ask a node for a transition; the function is called with the answer."""


class Host(Protocol):
    """Starts the processes and keeps the time of a launch."""

    def next_process_number(self) -> int:
        """The number after the dash in `navigator-1`, counted from 1."""

    def start_process(self, action: ExecuteLocal) -> None:
        """Have the action's process started as soon as the description has been walked through."""

    def call_later(self, seconds: float, function: Callable[[], None]) -> None:
        """Have a function called after some robot time."""

    def settle_soon(self) -> None:
        """Have the waiting events handled, still at this instant."""

    def ros_helper(self) -> RosHelper:
        """The node of launch's own; it is made when it is first asked for."""
