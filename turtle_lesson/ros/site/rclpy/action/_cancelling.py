"""Which goals a cancel request is about (rcl_action's action_server.c, action_msgs/srv/CancelGoal)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from action_msgs.srv import CancelGoal

from turtle_lesson.ros.core import NANOSECONDS

from ._goal_states import is_cancelable
from ._goals import key_of

if TYPE_CHECKING:
    from ._goal_handle import ServerGoalHandle

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
