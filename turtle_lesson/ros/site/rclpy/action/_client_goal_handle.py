"""A goal, as the client sees it that has sent it."""

from __future__ import annotations

from types import GenericAlias
from typing import TYPE_CHECKING, Any

from action_msgs.msg import GoalStatus

from ..task import Future

if TYPE_CHECKING:
    from .client import ActionClient


class ClientGoalHandle:
    """A goal, as the client sees it that has sent it. Made by ActionClient."""

    __module__ = "rclpy.action.client"
    __class_getitem__: Any = classmethod(
        GenericAlias
    )  # newer releases: ClientGoalHandle[Goal, Result, Feedback] in a hint

    def __init__(self, action_client: ActionClient, goal_id: Any, goal_response: Any) -> None:
        self._action_client = action_client
        self._goal_id = goal_id
        self._goal_response = goal_response
        self._status = GoalStatus.STATUS_UNKNOWN

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ClientGoalHandle) and self._goal_id == other.goal_id

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"ClientGoalHandle <id={self.goal_id.uuid}, accepted={self.accepted}, status={self.status}>"

    @property
    def goal_id(self) -> Any:
        """The goal's number, a unique_identifier_msgs.msg.UUID."""
        return self._goal_id

    @property
    def stamp(self) -> Any:
        """When the server accepted the goal, a builtin_interfaces.msg.Time."""
        return self._goal_response.stamp

    @property
    def accepted(self) -> bool:
        """Whether the server accepted the goal."""
        return self._goal_response.accepted

    @property
    def status(self) -> int:
        """The goal's state as last heard of, one of action_msgs.msg.GoalStatus."""
        return self._status

    def cancel_goal(self) -> Any:
        """Ask to cancel the goal, and wait for the answer. Not for callbacks: see ActionClient.send_goal."""
        return self._action_client._cancel_goal(self)

    def cancel_goal_async(self) -> Future:
        """Ask to cancel the goal; the future will have a CancelGoal.Response."""
        return self._action_client._cancel_goal_async(self)

    def get_result(self) -> Any:
        """Wait for the goal's end; returns its `status` and `result`. Not for callbacks: see ActionClient.send_goal."""
        return self._action_client._get_result(self)

    def get_result_async(self) -> Future:
        """Ask for the goal's result; the future will have its `status` and `result` when it has ended."""
        return self._action_client._get_result_async(self)
