"""What an action is made of: three services and two topics, with names that the lists of tools leave out.

Names and types are those of rcl_action (names.c) and of https://design.ros2.org/articles/actions.html. The node makes
the parts as it makes all others; then they are taken out of its hands, for an executor sees the action as one thing.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .._entity import Entity
from .._mistakes import no_node
from .._waitables import WaitableEntity
from ..exceptions import NameValidationException
from ..type_support import check_for_type_support

if TYPE_CHECKING:
    from .._executor import Executor
    from ..node import Node

SERVICES = ("send_goal", "cancel_goal", "get_result")
TOPICS = ("feedback", "status")

ORDER = {
    "client": "The order is ActionClient(node, action_type, action_name).",
    "server": "The order is ActionServer(node, action_type, action_name, execute_callback).",
}


def check_action(role: str, node: Any, action_type: Any) -> None:
    """Raise TypeError, AttributeError or RuntimeError for what is no node or no action type."""
    if not hasattr(node, "_ros_waiting_entities"):
        raise no_node(node)
    node._ros_check_alive()
    try:
        check_for_type_support(action_type)
    except AttributeError as error:
        error.add_note(f"{ORDER[role]} An action's class is wanted, such as example_interfaces.action.Fibonacci.")
        raise
    if not hasattr(action_type, "Impl"):
        error = RuntimeError(
            f"The action type provided is not valid ({action_type}), this might be a message or service"
        )
        name, _, part = getattr(action_type, "__name__", "").rpartition("_")
        if part in {"Goal", "Result", "Feedback"}:
            error.add_note(f"The action's type is {name}; {name}.{part} is only a part of it.")
        raise error


def full_names(role: str, node: Node, action_name: Any) -> dict[str, str]:
    """The full names of an action's parts, and of the action itself as "". Raises ValueError for a bad name.

    A remapping may name the action (as newer releases allow) or one of the parts.
    """
    try:
        whole = node._ros_full_name_of(action_name, is_service=True)
        parts = {part: f"{whole}/_action/{part}" for part in (*SERVICES, *TOPICS)}
        return {"": whole} | {
            part: node._ros_full_name_of(name, is_service=part in SERVICES) for part, name in parts.items()
        }
    except NameValidationException as error:
        raise ValueError(
            f"Failed to create action {role} due to invalid topic name '{action_name}': {error}"
        ) from None


def detached(node: Node, part: Any) -> Any:
    """A service, client, subscription or publisher that the node has just made, no longer among those of the node."""
    for parts in (node._ros_waiting_entities, node._ros_publishers):
        if part in parts:
            parts.remove(part)
    if isinstance(part, Entity):
        part._executor = None
    return part


class ActionEntity(WaitableEntity):
    """An action server or client in a node. Its parts go with it: to an executor, and out of the graph."""

    def __init__(self, waitable: Any, parts: list[Any], queues: list[deque[Any]]) -> None:
        self._parts = parts
        self._queues = queues
        super().__init__(waitable)

    def __repr__(self) -> str:
        return repr(self.waitable)

    @property
    def _executor(self) -> Executor | None:  # type: ignore[override]
        return self._runs_it

    @_executor.setter
    def _executor(self, executor: Executor | None) -> None:
        self._runs_it = executor
        for part in self._parts:
            if isinstance(part, Entity):
                part._executor = executor

    @property
    def _waiting(self) -> bool:
        """Whether it may call something of the program's."""
        return self.waitable._may_call_back()

    def _has_work(self) -> bool:
        return any(self._queues)

    def _take(self) -> tuple[Any, ...]:
        data = self.waitable.take_data()
        if any(self._queues):
            self._signal()
        return (data,)

    def destroy(self) -> None:
        """Leave the node and the graph."""
        if not self._destroyed:
            super().destroy()
            for part in self._parts:
                part.destroy()
            self.waitable._ended()


def made(node: Node, makers: list[Callable[[], Any]]) -> list[Any]:
    """All the parts, or none if one of them cannot be made."""
    parts: list[Any] = []
    try:
        for make in makers:
            parts.append(detached(node, make()))
    except Exception:
        for part in parts:
            part.destroy()
        raise
    return parts
