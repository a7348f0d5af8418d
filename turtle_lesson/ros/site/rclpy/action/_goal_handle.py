"""A goal, as its server sees it."""

from __future__ import annotations

from collections.abc import Callable
from types import GenericAlias
from typing import TYPE_CHECKING, Any

from action_msgs.msg import GoalStatus

from .._mistakes import shown
from ._goal_states import ACTIVE, NAMES, GoalEvent, state_after

if TYPE_CHECKING:
    from .server import ActionServer


class ServerGoalHandle:
    """A goal that the server has accepted. Made by ActionServer; callbacks are given it.

    An execute callback ends the goal with `succeed()`, `abort()` or `canceled()`, and returns the result.
    """

    __module__ = "rclpy.action.server"
    __class_getitem__: Any = classmethod(
        GenericAlias
    )  # newer releases: ServerGoalHandle[Goal, Result, Feedback] in a hint

    def __init__(self, action_server: ActionServer, goal_info: Any, goal_request: Any) -> None:
        self._action_server: ActionServer | None = action_server
        self._action_type = action_server.action_type
        self._goal_info = goal_info
        self._goal_request = goal_request
        self._for_all = GoalStatus(
            goal_info=goal_info, status=GoalStatus.STATUS_ACCEPTED
        )  # what the status topic tells

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ServerGoalHandle) and self.goal_id == other.goal_id

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<ServerGoalHandle {bytes(self.goal_id.uuid).hex()}, {NAMES[self.status].lower()}>"

    @property
    def request(self) -> Any:
        """The goal's message."""
        return self._goal_request

    @property
    def goal_id(self) -> Any:
        """The goal's number, a unique_identifier_msgs.msg.UUID."""
        return self._goal_info.goal_id

    @property
    def is_active(self) -> bool:
        """Whether the goal has not ended yet."""
        return self.status in ACTIVE

    @property
    def is_cancel_requested(self) -> bool:
        """Whether the goal is to be cancelled: a request for that came, and cancel_callback accepted it."""
        return self.status == GoalStatus.STATUS_CANCELING

    @property
    def status(self) -> int:
        """The goal's state, one of action_msgs.msg.GoalStatus; STATUS_UNKNOWN once the server has forgotten the goal."""
        server = self._server()
        return GoalStatus.STATUS_UNKNOWN if server is None else self._for_all.status

    def _server(self) -> ActionServer | None:
        if self._action_server is not None:
            self._action_server._forget_expired()
        return self._action_server

    def _update_state(self, event: GoalEvent) -> None:
        server = self._server()
        if server is None:
            return
        self._for_all.status = state_after(self._for_all.status, event)
        server._publish_status()
        if self._for_all.status not in ACTIVE:
            server._note_ended(self)

    def execute(self, execute_callback: Callable[[ServerGoalHandle], Any] | None = None) -> None:
        """Have the server's execute callback, or another one, called for this goal, by the executor, soon.

        A goal that is to be cancelled already is executed, too: so the callback can clean up and call `canceled()`.
        """
        server = self._server()
        if not self.is_cancel_requested:
            self._update_state(GoalEvent.EXECUTE)
        if server is not None:
            server.notify_execute(self, execute_callback)

    def publish_feedback(self, feedback: Any) -> None:
        """Tell the client that sent the goal about its progress. Raises TypeError for anything but the action's Feedback."""
        if not isinstance(feedback, self._action_type.Feedback):
            name = f"{self._action_type.__name__}.Feedback"
            raise TypeError(f"feedback is of type {name}, got {shown(feedback)}: try {name}(…)")
        server = self._server()
        if server is not None:
            server._publish_feedback(self.goal_id, feedback)

    def succeed(self) -> None:
        """The goal is reached."""
        self._update_state(GoalEvent.SUCCEED)

    def abort(self) -> None:
        """The goal cannot be reached, or is given up."""
        self._update_state(GoalEvent.ABORT)

    def canceled(self) -> None:
        """The goal is cancelled, as was asked for. Raises RCLError if nobody has asked."""
        self._update_state(GoalEvent.CANCELED)

    def destroy(self) -> None:
        """Let the goal go: it is not followed any more."""
        self._action_server = None
