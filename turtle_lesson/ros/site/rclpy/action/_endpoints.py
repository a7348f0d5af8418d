"""What an action is made of: three services and two topics, with names that the lists of tools leave out.

Names and types are those of rcl_action (names.c) and of https://design.ros2.org/articles/actions.html. The node makes
the parts as it makes all others; then they are taken out of its hands, for an executor sees the action as one thing.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from random import Random
from typing import Any

from unique_identifier_msgs.msg import UUID

from turtle_lesson.ros.runtime.world import current_process

from .._entity import WAITABLE, Entity
from .._hints import is_raised_by_the_call, no_node
from ..callback_groups import CallbackGroup
from ..exceptions import NameValidationException
from ..node import Node
from ..qos import QoSProfile
from ..type_support import check_for_type_support, wrong_kind

PARTS = {
    "goal": ("send_goal", "SendGoalService"),
    "cancel": ("cancel_goal", "CancelGoalService"),
    "result": ("get_result", "GetResultService"),
    "feedback": ("feedback", "FeedbackMessage"),
    "status": ("status", "GoalStatusMessage"),
}
"""The parts, by what `execute` calls what comes from each: its name below the action's, and that of its type in `Impl`."""
TOPICS = ("feedback", "status")


def check_action(role: str, node: Node, action_type: Any) -> None:
    """Raise TypeError, AttributeError or RuntimeError for what is no node or no action type."""
    if not hasattr(node, "_ros_waiting_entities"):
        raise no_node(node)
    node._ros_check_alive(f"Failed to create action {role}: rcl node's")
    try:
        check_for_type_support(action_type)
    except AttributeError as error:
        last = ", execute_callback" if role == "server" else ""
        error.add_note(
            f"The order is Action{role.title()}(node, action_type, action_name{last}). It needs an action's class, such as "
            "example_interfaces.action.Fibonacci."
        )
        raise
    if not hasattr(action_type, "Impl"):
        raise wrong_kind("action", action_type, "a message or service")


def full_names(role: str, node: Node, action_name: Any) -> dict[str, str]:
    """The full names of an action's parts, and of the action itself as "". Raises ValueError for a bad name.

    A remapping may name the action (as newer releases allow) or one of the parts.
    """
    try:
        whole = node._ros_full_name_of(action_name, is_service=True)
        return {"": whole} | {
            kind: node._ros_full_name_of(f"{whole}/_action/{name}", is_service=kind not in TOPICS)
            for kind, (name, _) in PARTS.items()
        }
    except NameValidationException as error:
        raise ValueError(f"Failed to create action {role} due to invalid topic name '{action_name}': {error}") from None


class ActionEndpoint(Entity):
    """Base class of action clients and servers. Its parts go with it: to an executor, and out of the graph.

    Each of the `profiles` is for the part at the same place in PARTS.
    """

    _kind = WAITABLE
    _node: Node

    def __init__(
        self,
        role: str,
        node: Node,
        action_type: Any,
        action_name: str,
        callback_group: CallbackGroup | None,
        profiles: Iterable[QoSProfile],
    ) -> None:
        check_action(role, node, action_type)
        self._parts: dict[str, Any] = {}
        self._arrived: dict[str, Any] = {}
        super().__init__(self.execute, callback_group or node.default_callback_group)
        self._node = node
        self._action_type = action_type
        self._action_name = action_name
        names = full_names(role, node, action_name)
        self._name = names[""]
        for (kind, (_, type_name)), profile in zip(PARTS.items(), profiles, strict=True):
            part, queue = self._make_part(kind, getattr(action_type.Impl, type_name), names[kind], profile)
            self._parts[kind] = part
            _take_from_node(node, part)
            if queue is not None:
                self._arrived[kind] = queue
                queue.wake = self._arrive
        node._ros_keep(self)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self._name}>"

    def __exit__(self, *error: object) -> None:
        """Nothing is released: as in rclpy, the endpoint lives on."""

    def _make_part(self, kind: str, part_type: Any, name: str, profile: QoSProfile) -> tuple[Any, Any]:
        """Have the node make one of the five parts. Returns it, and its end in the graph if things arrive there, or None."""
        raise NotImplementedError

    def take_data(self) -> dict[str, Any]:
        """Take one thing of each kind that has arrived."""
        queues = {kind: end.queue for kind, end in self._arrived.items() if end.queue}
        taken = {kind: queue[0] for kind, queue in queues.items()}
        for queue in queues.values():
            del queue[0]
        return taken

    async def execute(self, taken_data: dict[str, Any]) -> None:
        """Do what the things that were taken ask for."""
        raise NotImplementedError

    def _has_work(self) -> bool:
        return any(end.queue for end in self._arrived.values())

    def _take(self) -> tuple[Any, ...]:
        data = self.take_data()
        if self._has_work():
            self._signal()
        return (data,)

    def _arrive(self) -> None:
        """A message or request has come; it is taken when the executor gets to it."""
        self._signal()

    def destroy(self) -> None:
        """Leave the action: answers under way are dropped, goals that go on are not followed any more."""
        if not self._destroyed:
            super().destroy()
            for part in self._parts.values():
                part.destroy()


def _take_from_node(node: Node, part: Any) -> None:
    """Take what the node has just made out of the things that it has."""
    things: list[Any] = node._ros_waiting_entities if isinstance(part, Entity) else node._ros_publishers
    place = next(place for place in reversed(range(len(things))) if things[place] is part)  # it is among the last
    del things[place]
    if isinstance(part, Entity):
        node._ros_assignment.missed.pop(part, None)


class _GoalIds(Random):
    """Where the numbers of a process's goals come from."""


def new_goal_id() -> Any:
    """A number that no other goal has, from a source of its own, so that a program's random numbers do not shift."""
    from uuid import UUID as Number  # takes long to import, and few programs send goals

    process = current_process()
    source = process.state(_GoalIds, f"{process.seed}/goal ids")
    return UUID(uuid=list(Number(int=source.getrandbits(128), version=4).bytes))


async def call_back(role: str, callback: Callable[[Any], Any], argument: Any) -> Any:
    """Call a callback that plays a role in an action, and await what it returns if it is an `async def`."""
    try:
        result = callback(argument)
    except TypeError as error:
        if is_raised_by_the_call(error):
            error.add_note(f"The {role} of an action is called with one argument: def {role}(self, argument).")
        raise
    return await result if inspect.iscoroutinefunction(callback) else result
