"""The goals of an action server, their states, and which of them a cancel request is about."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from types import GenericAlias
from typing import TYPE_CHECKING, Any

from action_msgs.msg import GoalStatus
from action_msgs.srv import CancelGoal

from turtle_lesson.ros.sim.simulation import NANOSECONDS, NEVER

from .._hints import shown
from ..exceptions import RCLError

if TYPE_CHECKING:
    from .server import ActionServer


def key_of(goal_id: Any) -> bytes:
    """A goal's number (a UUID message) as what can be looked up."""
    return bytes(goal_id.uuid)


# The states of a goal, and which event leads to which (rcl_action's goal_state_machine.c).
#
#     accepted ──EXECUTE──▸ executing ──SUCCEED──▸ succeeded
#         │                     │ └─────ABORT────▸ aborted
#         └──────CANCEL_GOAL────┴▸ canceling ──CANCELED──▸ canceled (or SUCCEED, or ABORT)

NAMES = {
    getattr(GoalStatus, f"STATUS_{name}"): name
    for name in ("UNKNOWN", "ACCEPTED", "EXECUTING", "CANCELING", "SUCCEEDED", "CANCELED", "ABORTED")
}


class GoalEvent(Enum):
    """What can happen to a goal."""

    EXECUTE = 0
    CANCEL_GOAL = 1
    SUCCEED = 2
    ABORT = 3
    CANCELED = 4


ACTIVE = frozenset({GoalStatus.STATUS_ACCEPTED, GoalStatus.STATUS_EXECUTING, GoalStatus.STATUS_CANCELING})

_NEXT = {
    (GoalStatus.STATUS_ACCEPTED, GoalEvent.EXECUTE): GoalStatus.STATUS_EXECUTING,
    (GoalStatus.STATUS_ACCEPTED, GoalEvent.CANCEL_GOAL): GoalStatus.STATUS_CANCELING,
    (GoalStatus.STATUS_EXECUTING, GoalEvent.CANCEL_GOAL): GoalStatus.STATUS_CANCELING,
    (GoalStatus.STATUS_EXECUTING, GoalEvent.SUCCEED): GoalStatus.STATUS_SUCCEEDED,
    (GoalStatus.STATUS_EXECUTING, GoalEvent.ABORT): GoalStatus.STATUS_ABORTED,
    (GoalStatus.STATUS_CANCELING, GoalEvent.SUCCEED): GoalStatus.STATUS_SUCCEEDED,
    (GoalStatus.STATUS_CANCELING, GoalEvent.ABORT): GoalStatus.STATUS_ABORTED,
    (GoalStatus.STATUS_CANCELING, GoalEvent.CANCELED): GoalStatus.STATUS_CANCELED,
}


def state_after(state: int, event: GoalEvent) -> int:
    """The state that an event leads to. Raises RCLError where it is not allowed, with what to do instead as a note."""
    following = _NEXT.get((state, event))
    if following is not None:
        return following
    advice = f"This goal has already ended ({NAMES[state]}). End a goal once, and return the result right after."
    if state in ACTIVE:
        advice = (
            "execute() begins a goal, once (the default handle_accepted_callback calls it); succeed() and abort() end a "
            "goal that has begun; canceled() ends one whose goal_handle.is_cancel_requested is true: check that first."
        )
    text = f"goal_handle attempted invalid transition from state {NAMES[state]} with event {event.name}"
    error = RCLError(f"Failed to update goal state: {text}")
    error.add_note(advice)
    raise error


class ServerGoalHandle:
    """A goal that the server has accepted. Made by ActionServer; callbacks are given it.

    An execute callback ends the goal with `succeed()`, `abort()` or `canceled()`, and returns the result.
    """

    __module__ = "rclpy.action.server"
    __class_getitem__: Any = classmethod(GenericAlias)  # newer releases: ServerGoalHandle[…] in a hint

    def __init__(self, action_server: ActionServer, goal_info: Any, goal_request: Any) -> None:
        self._action_server: ActionServer | None = action_server
        self._action_type = action_server.action_type
        self._goal_info = goal_info
        self._goal_request = goal_request
        self._for_all = GoalStatus(goal_info=goal_info, status=GoalStatus.STATUS_ACCEPTED)  # as the status topic has it
        self._accepted_at = action_server._node._ros_simulation.now
        self._forgotten_at = NEVER  # ns; known when it has ended
        self._is_executing = False
        self._asked: list[Any] = []  # requests for the result, to be answered when it is known
        self._response: Any = None

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
            self._forgotten_at = server._keep_until(self._accepted_at)

    def _finish(self, response: Any) -> None:
        """The execute callback has returned: answer all requests for the result, those to come as well."""
        self._is_executing = False
        self._response = response
        for request in self._asked:
            request.answer(response)
        self._asked.clear()

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


def goals_to_cancel(goal_info: Any, goals: dict[bytes, ServerGoalHandle]) -> tuple[int, list[ServerGoalHandle]]:
    """The return code for a cancel request, and the goals that it may cancel.

    A number alone means that goal; a time alone all goals accepted until then; both mean both; neither means all
    (rcl_action's action_server.c, action_msgs/srv/CancelGoal).
    """
    wanted, until = key_of(goal_info.goal_id), _nanoseconds(goal_info.stamp)
    everything = not any(wanted) and not until
    found = [
        goal
        for key, goal in goals.items()
        if (everything or key == wanted or _nanoseconds(goal._goal_info.stamp) <= until)
        and (goal._for_all.status, GoalEvent.CANCEL_GOAL) in _NEXT
    ]
    if found or until or everything:
        return CancelGoal.Response.ERROR_NONE, found
    codes = CancelGoal.Response
    return codes.ERROR_GOAL_TERMINATED if wanted in goals else codes.ERROR_UNKNOWN_GOAL_ID, []


def _nanoseconds(stamp: Any) -> int:
    return stamp.sec * NANOSECONDS + stamp.nanosec
