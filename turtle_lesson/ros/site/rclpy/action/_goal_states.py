"""The states of a goal, and which event leads to which (rcl_action's goal_state_machine.c).

accepted ──EXECUTE──▸ executing ──SUCCEED──▸ succeeded
    │                  │    └────ABORT────▸ aborted
    └──CANCEL_GOAL─────┴▸ canceling ──CANCELED──▸ canceled   (or SUCCEED, or ABORT)
"""

from __future__ import annotations

from enum import Enum

from action_msgs.msg import GoalStatus

from ..exceptions import RCLError

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
