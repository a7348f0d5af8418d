"""What the callbacks of an action server answer, and the callbacks that it has unless it is given others."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._goal_handle import ServerGoalHandle


class GoalResponse(Enum):
    """What a goal_callback answers."""

    __module__ = "rclpy.action.server"

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """What a cancel_callback answers."""

    __module__ = "rclpy.action.server"

    REJECT = 1
    ACCEPT = 2


def default_handle_accepted_callback(goal_handle: ServerGoalHandle) -> None:
    """Execute each goal at once."""
    goal_handle.execute()


def default_goal_callback(goal_request: Any) -> GoalResponse:
    """Accept every goal."""
    return GoalResponse.ACCEPT


def default_cancel_callback(cancel_request: Any) -> CancelResponse:
    """Cancel no goal."""
    return CancelResponse.REJECT
