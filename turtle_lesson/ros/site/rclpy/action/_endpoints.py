"""What an action is made of: three services and two topics, with names that the lists of tools leave out.

Names and types are those of rcl_action (names.c) and of https://design.ros2.org/articles/actions.html. The node makes
the parts as it makes all others; then they are taken out of its hands, for an executor sees the action as one thing.
"""

from __future__ import annotations

import inspect
from collections import deque
from collections.abc import Callable
from random import Random
from types import GenericAlias
from typing import TYPE_CHECKING, Any
from uuid import UUID as Number

from unique_identifier_msgs.msg import UUID

from turtle_lesson.ros.runtime.world import current_process

from .._entity import WAITABLE, Entity
from .._hints import no_node
from ..exceptions import NameValidationException
from ..type_support import check_for_type_support

if TYPE_CHECKING:
    from ..executors import Executor
    from ..node import Node
    from ..qos import QoSProfile


SERVICES = {"send_goal": "SendGoalService", "cancel_goal": "CancelGoalService", "get_result": "GetResultService"}
TOPICS = {"feedback": "FeedbackMessage", "status": "GoalStatusMessage"}

ORDER = {
    "client": "The order is ActionClient(node, action_type, action_name).",
    "server": "The order is ActionServer(node, action_type, action_name, execute_callback).",
}

Make = Callable[[Any, str, "QoSProfile"], Any]


def check_action(role: str, node: Any, action_type: Any) -> None:
    """Raise TypeError, AttributeError or RuntimeError for what is no node or no action type."""
    if not hasattr(node, "_ros_waiting_entities"):
        raise no_node(node)
    node._ros_check_alive(f"Failed to create action {role}: rcl node's")
    try:
        check_for_type_support(action_type)
    except AttributeError as error:
        error.add_note(f"{ORDER[role]} It needs an action's class, such as example_interfaces.action.Fibonacci.")
        raise
    if not hasattr(action_type, "Impl"):
        problem = RuntimeError(
            f"The action type provided is not valid ({action_type}), this might be a message or service"
        )
        name, _, part = getattr(action_type, "__name__", "").rpartition("_")
        if part in {"Goal", "Result", "Feedback"}:
            problem.add_note(f"The action's type is {name}; {name}.{part} is only a part of it.")
        raise problem


def full_names(role: str, node: Node, action_name: Any) -> dict[str, str]:
    """The full names of an action's parts, and of the action itself as "". Raises ValueError for a bad name.

    A remapping may name the action (as newer releases allow) or one of the parts.
    """
    try:
        whole = node._ros_full_name_of(action_name, is_service=True)
        return {"": whole} | {
            part: node._ros_full_name_of(f"{whole}/_action/{part}", is_service=part in SERVICES)
            for part in (*SERVICES, *TOPICS)
        }
    except NameValidationException as error:
        raise ValueError(f"Failed to create action {role} due to invalid topic name '{action_name}': {error}") from None


def make_parts(
    node: Node,
    action_type: Any,
    names: dict[str, str],
    profiles: dict[str, QoSProfile],
    make_service: Make,
    make_topic: Make,
) -> dict[str, Any]:
    """The five ends of an action; or none of them, if one cannot be made."""
    parts: dict[str, Any] = {}
    try:
        for part, type_name in (SERVICES | TOPICS).items():
            make = make_service if part in SERVICES else make_topic
            kind = getattr(action_type.Impl, type_name)
            parts[part] = _detached(node, make(kind, names[part], profiles[part]))
    except Exception:
        for made in parts.values():
            made.destroy()
        raise
    return parts


def _detached(node: Node, part: Any) -> Any:
    """What the node has just made, no longer among the things that it has."""
    things: list[Any] = node._ros_waiting_entities if isinstance(part, Entity) else node._ros_publishers
    place = next(place for place in reversed(range(len(things))) if things[place] is part)  # it is among the last
    del things[place]
    if isinstance(part, Entity):
        part._executor = None
    return part


class ActionEndpoint:
    """Base class of action clients and servers."""

    __class_getitem__: Any = classmethod(GenericAlias)  # newer releases: ActionClient[Goal, Result, Feedback] in a hint
    _entity: ActionEntity
    _name: str

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *error: object) -> None:
        """Nothing is released: as in rclpy, the endpoint lives on."""

    def _on_arrival(self) -> None:
        """A message or request has come; it is taken when the executor gets to it."""

    def destroy(self) -> None:
        """Leave the action: answers under way are dropped, goals that go on are not followed any more."""
        self._entity.destroy()


class ActionEntity(Entity):
    """An action server or client in a node. Its parts go with it: to an executor, and out of the graph."""

    _kind = WAITABLE

    def __init__(self, action: Any, parts: dict[str, Any], queues: list[deque[Any]]) -> None:
        self._action = action
        self._parts = parts
        self._queues = queues
        super().__init__(action.execute, action.callback_group)

    def __repr__(self) -> str:
        return repr(self._action)

    @property
    def _executor(self) -> Executor | None:
        return self._runs_it

    @_executor.setter
    def _executor(self, executor: Executor | None) -> None:
        self._runs_it = executor
        for part in self._parts.values():
            if isinstance(part, Entity):
                part._executor = executor

    @property
    def _waiting(self) -> bool:
        """Whether it may call something of the program's."""
        return self._action._may_call_back()

    def _has_work(self) -> bool:
        return any(self._queues)

    def _take(self) -> tuple[Any, ...]:
        data = self._action.take_data()
        if any(self._queues):
            self._signal()
        return (data,)

    def _arrive(self) -> None:
        """Something has come."""
        self._action._on_arrival()
        self._signal()

    def destroy(self) -> None:
        """Leave the node and the graph."""
        if not self._destroyed:
            super().destroy()
            for part in self._parts.values():
                part.destroy()
            self._action._end()


class _GoalIds(Random):
    """Where the numbers of a process's goals come from."""


def new_goal_id() -> Any:
    """A number that no other goal has, from a source of its own, so that a program's random numbers do not shift."""
    process = current_process()
    source = process.state(_GoalIds, f"{process.seed}/goal ids")
    return UUID(uuid=list(Number(int=source.getrandbits(128), version=4).bytes))


ARGUMENTS = {
    "goal_callback": "goal_request",
    "handle_accepted_callback": "goal_handle",
    "cancel_callback": "goal_handle",
    "execute_callback": "goal_handle",
    "feedback_callback": "feedback_msg",
}


async def call_back(role: str, callback: Callable[[Any], Any], argument: Any) -> Any:
    """Call a callback that plays a role in an action, and await what it returns if it is an `async def`."""
    try:
        result = callback(argument)
    except TypeError as error:
        _explain(role, error)
        raise
    return await result if inspect.iscoroutinefunction(callback) else result


def _explain(role: str, error: TypeError) -> None:
    """Add to an error that the call itself raised, not the callback, how the callback is called."""
    trace = error.__traceback__
    if trace is not None and trace.tb_next is None:
        name = ARGUMENTS[role]
        error.add_note(f"The {role} of an action is called with one argument: def {role}(self, {name}).")
