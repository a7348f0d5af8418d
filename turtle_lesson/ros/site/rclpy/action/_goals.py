"""The goals that an action server knows: those that go on, and for some time those that have ended."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from enum import Enum
from heapq import heappop, heappush
from types import GenericAlias
from typing import TYPE_CHECKING, Any

from action_msgs.msg import GoalStatus
from action_msgs.srv import CancelGoal

from turtle_lesson.ros.sim.simulation import NANOSECONDS

from .._hints import shown
from ..exceptions import RCLError

if TYPE_CHECKING:
    from turtle_lesson.ros.sim.simulation import Simulation

    from .server import ActionServer


def key_of(goal_id: Any) -> bytes:
    """A goal's number (a UUID message) as what can be looked up."""
    return bytes(goal_id.uuid)


class Goals:
    """By their numbers, in the order in which they were accepted.

    The real server forgets the ended ones with a timer (rcl_action's action_server.c). Here it looks whenever somebody
    asks: nobody can tell the difference, and nothing keeps a world awake in which nothing happens any more.
    """

    def __init__(self, simulation: Simulation, timeout: int, *, after_their_end: bool) -> None:
        self._simulation = simulation
        self._timeout = timeout
        self._after_their_end = after_their_end
        self._accepted: dict[bytes, int] = {}
        self._handles: dict[bytes, ServerGoalHandle] = {}
        self._results: dict[bytes, Any] = {}
        self._asked: dict[bytes, list[Any]] = {}
        self._executing: set[bytes] = set()
        self._ended: list[tuple[int, bytes]] = []  # when (ns) they expire: a heap

    def __iter__(self) -> Iterator[ServerGoalHandle]:
        return iter(list(self._handles.values()))

    def get(self, goal_id: Any) -> ServerGoalHandle | None:
        """The goal of this number."""
        return self._handles.get(key_of(goal_id))

    def add(self, handle: ServerGoalHandle) -> None:
        """A goal was accepted."""
        key = key_of(handle.goal_id)
        self._handles[key] = handle
        self._accepted[key] = self._simulation.now

    def begin(self, handle: ServerGoalHandle) -> None:
        """A goal's execute callback is to be called: it is not forgotten before that has returned."""
        self._executing.add(key_of(handle.goal_id))

    def end(self, handle: ServerGoalHandle) -> None:
        """A goal has come to its end, and will be forgotten."""
        key = key_of(handle.goal_id)
        began = self._accepted.pop(key, self._simulation.now)
        heappush(self._ended, ((self._simulation.now if self._after_their_end else began) + self._timeout, key))

    def ask(self, goal_id: Any, request: Any) -> Any | None:
        """The result of a goal; None if it is not known yet: then this request will be among those to be answered."""
        key = key_of(goal_id)
        if key in self._results:
            return self._results[key]
        self._asked.setdefault(key, []).append(request)
        return None

    def finish(self, handle: ServerGoalHandle, result: Any) -> list[Any]:
        """A goal's execute callback has returned. Returns the requests that are to be answered now."""
        key = key_of(handle.goal_id)
        self._executing.discard(key)
        if key in self._handles:
            self._results[key] = result
        return self._asked.pop(key, [])

    def forget_expired(self) -> None:
        """Let go of those that have ended and expired."""
        ended, now = self._ended, self._simulation.now
        while ended and ended[0][0] < now and ended[0][1] not in self._executing:
            key = heappop(ended)[1]
            self._results.pop(key, None)
            handle = self._handles.pop(key, None)
            if handle is not None:
                handle.destroy()

    def forget_all(self) -> None:
        """Let go of all of them."""
        for handle in self._handles.values():
            handle.destroy()
        self._handles.clear()


# -- goal states --------------------------------------------------------------------------------------------------
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


def is_cancelable(state: int) -> bool:
    """Whether a goal in this state can still be cancelled."""
    return (state, GoalEvent.CANCEL_GOAL) in _NEXT


def state_after(state: int, event: GoalEvent) -> int:
    """The state that an event leads to. Raises RCLError where it is not allowed, with what to do instead as a note."""
    following = _NEXT.get((state, event))
    if following is None:
        error = RCLError(
            "Failed to update goal state: goal_handle attempted invalid transition "
            f"from state {NAMES[state]} with event {event.name}"
        )
        error.add_note(_advice(state, event))
        raise error
    return following


def _advice(state: int, event: GoalEvent) -> str:
    if state not in ACTIVE:
        return f"This goal has already ended ({NAMES[state]}). End a goal once, and return the result right after."
    if event is GoalEvent.EXECUTE:
        return "execute() has already been called for this goal: the default handle_accepted_callback also calls it."
    if state == GoalStatus.STATUS_ACCEPTED:
        return "This goal is not being executed yet: call goal_handle.execute(), and end it in the execute callback."
    return (
        "canceled() is for a goal whose cancellation was requested, and accepted by its cancel_callback: check "
        "goal_handle.is_cancel_requested first. To give up for another reason, call goal_handle.abort()."
    )


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
            server._goals.end(self)

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


# -- cancelling ---------------------------------------------------------------------------------------------------
# Which goals a cancel request is about (rcl_action's action_server.c, action_msgs/srv/CancelGoal).

NO_ID = bytes(16)


def goals_to_cancel(goal_info: Any, goals: Iterable[ServerGoalHandle]) -> tuple[int, list[ServerGoalHandle]]:
    """The return code for a request, and the goals that it may cancel.

    A number alone means that goal; a time alone all goals accepted until then; both mean both; neither means all.
    """
    wanted, until = key_of(goal_info.goal_id), _nanoseconds(goal_info.stamp)
    if wanted != NO_ID and not until:
        return _one(wanted, goals)
    everything = wanted == NO_ID and not until
    found = [
        goal
        for goal in goals
        if is_cancelable(goal.status)
        and (everything or _nanoseconds(goal._goal_info.stamp) <= until or key_of(goal.goal_id) == wanted)
    ]
    return CancelGoal.Response.ERROR_NONE, found


def _one(wanted: bytes, goals: Iterable[ServerGoalHandle]) -> tuple[int, list[ServerGoalHandle]]:
    for goal in goals:
        if key_of(goal.goal_id) == wanted:
            if is_cancelable(goal.status):
                return CancelGoal.Response.ERROR_NONE, [goal]
            return CancelGoal.Response.ERROR_GOAL_TERMINATED, []
    return CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID, []


def _nanoseconds(stamp: Any) -> int:
    return stamp.sec * NANOSECONDS + stamp.nanosec
