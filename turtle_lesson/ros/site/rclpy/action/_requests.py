"""What an action server does with the requests that come in: for goals, for cancelling, and for results."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from action_msgs.msg import GoalInfo, GoalStatus

from ..exceptions import RCLError
from ..impl.logging_severity import LoggingSeverity
from ._answers import CancelResponse, GoalResponse
from ._callbacks import call_back
from ._cancelling import goals_to_cancel
from ._goal_handle import ServerGoalHandle
from ._goal_states import GoalEvent
from ._goals import Goals

if TYPE_CHECKING:
    from ..node import Node


class Requests:
    """Mixed into ActionServer. Each request is that of a graph's service: it knows who asked."""

    _action_type: Any
    _cancel_callback: Callable[[ServerGoalHandle], Any]
    _goal_callback: Callable[[Any], Any]
    _goals: Goals
    _handle_accepted_callback: Callable[[ServerGoalHandle], Any]
    _node: Node

    if TYPE_CHECKING:

        def _publish_status(self) -> None: ...

    def _debug(self, text: str, goal_id: Any) -> None:
        """Log what only the developer of a server wants to see, with a goal's number."""
        logger = self._node.get_logger()
        if logger.is_enabled_for(LoggingSeverity.DEBUG):
            logger.debug(text.format(goal_id.uuid))

    async def _execute_goal_request(self, request: Any) -> None:
        message = request.message
        self._debug("New goal request with ID: {}", message.goal_id)
        info = GoalInfo(goal_id=message.goal_id)
        accepted = self._goals.get(message.goal_id) is None and await self._is_acceptable(message.goal)
        handle = None
        if accepted:
            info.stamp = self._node.get_clock().now().to_msg()
            accepted = not self._came_meanwhile(message.goal_id)
        if accepted:
            handle = ServerGoalHandle(self, info, message.goal)  # type: ignore[arg-type]
            self._goals.add(handle)
        response = self._action_type.Impl.SendGoalService.Response(accepted=accepted, stamp=info.stamp)
        request.answer(response)
        if handle is None:
            self._debug("New goal rejected: {}", message.goal_id)
            return
        self._debug("New goal accepted: {}", message.goal_id)
        self._publish_status()
        await call_back("handle_accepted_callback", self._handle_accepted_callback, handle)

    def _came_meanwhile(self, goal_id: Any) -> bool:
        """Whether a goal of the same number was accepted while the goal callback of this one decided."""
        if self._goals.get(goal_id) is None:
            return False
        text = f"Failed to accept new goal with ID {goal_id.uuid}: goal ID already exists"
        self._node.get_logger().error(text)
        return True

    async def _is_acceptable(self, goal: Any) -> bool:
        response = await call_back("goal_callback", self._goal_callback, goal)
        if not isinstance(response, GoalResponse):
            self._node.get_logger().warning("Goal request callback did not return a GoalResponse type. Rejecting goal.")
        return response is GoalResponse.ACCEPT

    async def _execute_cancel_request(self, request: Any) -> None:
        self._debug("Cancel request received for goal with ID: {}", request.message.goal_info.goal_id)
        response = self._action_type.Impl.CancelGoalService.Response()
        response.return_code, handles = goals_to_cancel(request.message.goal_info, self._goals)
        response.goals_canceling = [handle._goal_info for handle in handles if await self._cancel(handle)]
        request.answer(response)

    async def _cancel(self, handle: ServerGoalHandle) -> bool:
        """Whether the program lets this goal be cancelled."""
        logger = self._node.get_logger()
        response = await call_back("cancel_callback", self._cancel_callback, handle)
        if not isinstance(response, CancelResponse):
            logger.warning("Cancel callback did not return a CancelResponse type. Rejecting cancel request.")
        if response is not CancelResponse.ACCEPT:
            return False
        try:
            handle._update_state(GoalEvent.CANCEL_GOAL)
        except RCLError as error:  # it has ended meanwhile
            logger.debug(f"Failed to cancel goal in cancel callback: {error}")
            return False
        return True

    def _execute_result_request(self, request: Any) -> None:
        goal_id = request.message.goal_id
        self._debug("Result request received for goal with ID: {}", goal_id)
        if self._goals.get(goal_id) is None:
            self._debug("Sending result response for unknown goal ID: {}", goal_id)
            unknown = self._action_type.Impl.GetResultService.Response(status=GoalStatus.STATUS_UNKNOWN)
            request.answer(unknown)
            return
        response = self._goals.ask(goal_id, request)
        if response is not None:
            request.answer(response)
