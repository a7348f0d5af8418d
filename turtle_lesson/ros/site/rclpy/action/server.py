"""Action servers: the side that reaches goals.

As in rclpy, a server takes goals, cancel requests and requests for results in its callback group; but the execute
callback is a task of its own, in no group: in a MultiThreadedExecutor it runs beside everything, and in a single-threaded
one it holds up everything, the cancelling of its own goal included, unless it is an `async def` that awaits.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from enum import Enum
from typing import TYPE_CHECKING, Any

from action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray

from turtle_lesson.ros.core import NANOSECONDS
from turtle_lesson.ros.core.tracebacks import print_error

from ..callback_groups import CallbackGroup
from ..exceptions import RCLError
from ..qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default
from ..waitable import NumberOfEntities, Waitable
from ._callbacks import call_back
from ._cancelling import goals_to_cancel
from ._ends import SERVICES, ActionEntity, check_action, full_names, made
from ._goal_handle import ServerGoalHandle
from ._goal_states import NAMES, GoalEvent
from ._tracing import traced

if TYPE_CHECKING:
    from ..node import Node

__all__ = [
    "ActionServer",
    "CancelResponse",
    "GoalEvent",
    "GoalResponse",
    "RCLError",
    "ServerGoalHandle",
    "default_cancel_callback",
    "default_goal_callback",
    "default_handle_accepted_callback",
]


class GoalResponse(Enum):
    """What a goal_callback answers."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """What a cancel_callback answers."""

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


class ActionServer(Waitable):
    """Offers an action.

    Args:
        node: whose action it is.
        action_type: the action's class, such as example_interfaces.action.Fibonacci.
        action_name: its name.
        execute_callback: called with a ServerGoalHandle, to reach the goal; returns an action_type.Result.
        callback_group: for the taking of goals and of cancel requests; the node's default one if none is given.
        goal_callback: called with the goal's message; returns a GoalResponse.
        handle_accepted_callback: called with the ServerGoalHandle of a new goal; calls its `execute()`, now or later.
        cancel_callback: called with the ServerGoalHandle of a goal that is to be cancelled; returns a CancelResponse.
        result_timeout: how long, in s, a goal that has ended is remembered, so that its result can be asked for.
    """

    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        execute_callback: Callable[[ServerGoalHandle], Any] | None,
        *,
        callback_group: CallbackGroup | None = None,
        goal_callback: Callable[[Any], Any] | None = default_goal_callback,
        handle_accepted_callback: Callable[[ServerGoalHandle], Any] | None = default_handle_accepted_callback,
        cancel_callback: Callable[[ServerGoalHandle], Any] | None = default_cancel_callback,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_pub_qos_profile: QoSProfile = QoSProfile(depth=10),  # noqa: B008
        status_pub_qos_profile: QoSProfile = qos_profile_action_status_default,
        result_timeout: float = 900,
    ) -> None:
        check_action("server", node, action_type)
        super().__init__(node.default_callback_group if callback_group is None else callback_group)
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_goal_callback(goal_callback)
        self.register_cancel_callback(cancel_callback)
        self.register_execute_callback(execute_callback)
        self._node = node
        self._action_type = action_type
        self._timeout = round(result_timeout * NANOSECONDS)
        self._goal_handles: dict[bytes, ServerGoalHandle] = {}
        self._results: dict[bytes, Any] = {}
        self._asked_for_results: dict[bytes, list[Any]] = {}
        self._ended_goals: deque[tuple[int, bytes]] = deque()  # until when each is kept (ns), in this order
        names = full_names("server", node, action_name)
        self._name = names[""]
        impl, group = action_type.Impl, self.callback_group
        services: list[tuple[Any, str, QoSProfile]] = [
            (impl.SendGoalService, names["send_goal"], goal_service_qos_profile),
            (impl.CancelGoalService, names["cancel_goal"], cancel_service_qos_profile),
            (impl.GetResultService, names["get_result"], result_service_qos_profile),
        ]
        topics: list[tuple[Any, str, QoSProfile]] = [
            (impl.FeedbackMessage, names["feedback"], feedback_pub_qos_profile),
            (impl.GoalStatusMessage, names["status"], status_pub_qos_profile),
        ]
        parts = made(
            node,
            [
                *(
                    lambda kind=kind, name=name, qos=qos: node.create_service(
                        kind, name, None, qos_profile=qos, callback_group=group
                    )
                    for kind, name, qos in services
                ),
                *(lambda kind=kind, name=name, qos=qos: node.create_publisher(kind, name, qos) for kind, name, qos in topics),
            ],
        )
