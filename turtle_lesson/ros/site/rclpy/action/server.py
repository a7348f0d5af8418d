"""Action servers: the side that reaches goals.

As in rclpy, a server takes goals, cancel requests and requests for results in its callback group; but the execute
callback is a task of its own, in no group: in a MultiThreadedExecutor it runs beside everything, and in a single-threaded
one it holds up everything, the cancelling of its own goal included, unless it is an `async def` that awaits.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from enum import Enum
from typing import TYPE_CHECKING, Any

from action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray

from turtle_lesson.ros.distro import GOALS_EXPIRE_AFTER_THEIR_END
from turtle_lesson.ros.rmw.trace import Callback
from turtle_lesson.ros.runtime.world import current_world
from turtle_lesson.ros.sim.errors import print_error
from turtle_lesson.ros.sim.simulation import NANOSECONDS

from .._reexports import reexported
from .._tracing import name_of
from ..callback_groups import CallbackGroup
from ..exceptions import RCLError
from ..impl.logging_severity import LoggingSeverity
from ..qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default
from ._endpoints import ActionEndpoint, ActionEntity, call_back, check_action, full_names, make_parts
from ._goals import GoalEvent, Goals, ServerGoalHandle, goals_to_cancel

if TYPE_CHECKING:
    from ..node import Node


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


FEEDBACK = QoSProfile(depth=10)

OVERHEAD = 200_000
"""What a real rclpy needs, about, from `execute()` to the execute callback (ns). So the client that sent the
goal hears that it was accepted before there is any feedback."""


class ActionServer(ActionEndpoint):
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
        result_timeout: how long, in s, a goal that has ended is remembered, so that its result can be asked for. Until
            Iron this time begins when the goal is accepted.
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
        feedback_pub_qos_profile: QoSProfile = FEEDBACK,
        status_pub_qos_profile: QoSProfile = qos_profile_action_status_default,
        result_timeout: float = 900,
    ) -> None:
        check_action("server", node, action_type)
        self.callback_group = node.default_callback_group if callback_group is None else callback_group
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_goal_callback(goal_callback)
        self.register_cancel_callback(cancel_callback)
        self.register_execute_callback(execute_callback)
        self._node = node
        self._action_type = action_type
        after = current_world().release.has(GOALS_EXPIRE_AFTER_THEIR_END)
        self._goals = Goals(node._ros_simulation, round(result_timeout * NANOSECONDS), after_their_end=after)
        self._traced: dict[str, Callback] = {}
        profiles = {
            "send_goal": goal_service_qos_profile,
            "cancel_goal": cancel_service_qos_profile,
            "get_result": result_service_qos_profile,
            "feedback": feedback_pub_qos_profile,
            "status": status_pub_qos_profile,
        }
        self._make_parts(full_names("server", node, action_name), profiles)

    def _make_parts(self, names: dict[str, str], profiles: dict[str, QoSProfile]) -> None:
        node, group = self._node, self.callback_group

        def make_service(kind: Any, name: str, profile: QoSProfile) -> Any:
            return node.create_service(kind, name, None, qos_profile=profile, callback_group=group)  # type: ignore[arg-type]

        self._name = names[""]
        parts = make_parts(node, self._action_type, names, profiles, make_service, node.create_publisher)
        self._feedback, self._status = parts["feedback"], parts["status"]
        self._services = [parts["send_goal"], parts["cancel_goal"], parts["get_result"]]
        ends = [service._server for service in self._services]
        self._requests = dict(zip(("goal", "cancel", "result"), ends, strict=True))
        self._entity = ActionEntity(self, parts, [end.queue for end in ends])
        for end in ends:
            end.wake = self._entity._arrive
        node._ros_keep(self._entity)

    def __repr__(self) -> str:
        return f"<ActionServer of {self._name}>"

    @property
    def action_type(self) -> Any:
        """The action's class."""
        return self._action_type

    # -- callbacks -------------------------------------------------------------------------------------------------

    def register_handle_accepted_callback(
        self, handle_accepted_callback: Callable[[ServerGoalHandle], Any] | None
    ) -> None:
        """Have this called for new goals from now on; None: execute them at once."""
        self._handle_accepted_callback = handle_accepted_callback or default_handle_accepted_callback

    def register_goal_callback(self, goal_callback: Callable[[Any], Any] | None) -> None:
        """Have this decide about new goals from now on; None: accept all."""
        self._goal_callback = goal_callback or default_goal_callback

    def register_cancel_callback(self, cancel_callback: Callable[[ServerGoalHandle], Any] | None) -> None:
        """Have this decide from now on whether goals are cancelled; None: cancel none."""
        self._cancel_callback = cancel_callback or default_cancel_callback

    def register_execute_callback(self, execute_callback: Callable[[ServerGoalHandle], Any] | None) -> None:
        """Have this called from now on to reach goals. None calls nothing, as in newer releases: goals stay unended."""
        if execute_callback is not None and not callable(execute_callback):
            error = TypeError("Failed to register goal execution callback: not callable")
            error.add_note("Hand over the function itself, as in self.execute_callback, without brackets.")
            raise error
        self._execute_callback = execute_callback

    # -- what comes in ---------------------------------------------------------------------------------------------

    def take_data(self) -> dict[str, Any]:
        """Take one request of each kind."""
        return {kind: end.take() for kind, end in self._requests.items() if end.queue}

    async def execute(self, taken_data: dict[str, Any]) -> None:
        """Do what the requests ask for."""
        if "goal" in taken_data:
            await self._execute_goal_request(taken_data["goal"])
        if "cancel" in taken_data:
            await self._execute_cancel_request(taken_data["cancel"])
        if "result" in taken_data:
            self._execute_result_request(taken_data["result"])

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
            accepted = self._goals.get(message.goal_id) is None
            if not accepted:  # another one of the same number was accepted while the goal callback decided
                text = f"Failed to accept new goal with ID {message.goal_id.uuid}: goal ID already exists"
                self._node.get_logger().error(text)
        if accepted:
            handle = ServerGoalHandle(self, info, message.goal)
            self._goals.add(handle)
        response = self._action_type.Impl.SendGoalService.Response(accepted=accepted, stamp=info.stamp)
        request.answer(response)
        if handle is None:
            self._debug("New goal rejected: {}", message.goal_id)
            return
        self._debug("New goal accepted: {}", message.goal_id)
        self._publish_status()
        await call_back("handle_accepted_callback", self._handle_accepted_callback, handle)

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

    # -- executing goals -------------------------------------------------------------------------------------------

    def notify_execute(
        self, goal_handle: ServerGoalHandle, execute_callback: Callable[[ServerGoalHandle], Any] | None
    ) -> None:
        """Have a callback, or the server's own, called for a goal by the executor of the node."""
        callback = execute_callback or self._execute_callback
        if callback is None:
            return
        executor = self._node.executor
        if executor is None:
            raise RuntimeError(
                f"no executor spins {self._node!r}, so nothing can call the execute callback of {self._name}: add the "
                "node to an executor first, with executor.add_node(node)"
            )
        self._goals.begin(goal_handle)
        executor.create_task(self._execute_goal, callback, goal_handle, self._node._ros_simulation.now)

    async def _execute_goal(
        self, execute_callback: Callable[..., Any], goal_handle: ServerGoalHandle, ready: int
    ) -> None:
        logger, simulation = self._node.get_logger(), self._node._ros_simulation
        self._debug("Executing goal with ID {}", goal_handle.goal_id)
        simulation.sleep_until(simulation.now + OVERHEAD)
        try:
            with self._traced_run(execute_callback, ready):
                result = await call_back("execute_callback", execute_callback, goal_handle)
        except Exception as error:
            result = self._action_type.Result()
            logger.error(f"Error raised in execute callback: {error}")
            print_error(error)
        if goal_handle.is_active:
            logger.warning(f"Goal state not set, assuming aborted. Goal ID: {goal_handle.goal_id.uuid}")
            goal_handle.abort()
        self._debug(f"Goal with ID {{}} finished with state {goal_handle.status}", goal_handle.goal_id)
        response = self._result_response(goal_handle.status, result)
        for request in self._goals.finish(goal_handle, response):
            request.answer(response)

    @contextmanager
    def _traced_run(self, callback: Callable[..., Any], ready: int) -> Iterator[None]:
        """Put an execute callback, which could have begun when it was `ready` (ns), into the world's trace, if it keeps one."""
        entry, trace = self._node._ros_entry, self._node._ros_graph.trace
        if trace is None or entry.hidden:
            yield
            return
        name = name_of(callback)
        if name not in self._traced:
            awaits = inspect.iscoroutinefunction(callback)
            self._traced[name] = Callback(entry.full_name, name, "action", self._name, 0, entry.process.pid, awaits)
            trace.callbacks.append(self._traced[name])
        record, begun = self._traced[name], (ready, trace.now)
        record.open.append(begun)
        try:
            yield
        finally:
            record.open.remove(begun)
            record.ended.append((*begun, trace.now))

    def notify_goal_done(self) -> None:
        """A goal has ended: look which ones have expired. The server does that for itself, too."""
        self._forget_expired()

    def _result_response(self, status: int, result: Any) -> Any:
        try:
            return self._action_type.Impl.GetResultService.Response(status=status, result=result)
        except AssertionError as error:
            name = self._action_type.__name__
            error.add_note(
                f"The execute callback of {self._name} returned {result!r}, where a {name}.Result is expected: end it "
                f"with `return {name}.Result(…)`, on every way out."
            )
            raise

    # -- what goes out ---------------------------------------------------------------------------------------------

    def _publish_status(self) -> None:
        self._forget_expired()
        self._status.publish(GoalStatusArray(status_list=[goal._for_all for goal in self._goals]))

    def _publish_feedback(self, goal_id: Any, feedback: Any) -> None:
        self._feedback.publish(self._action_type.Impl.FeedbackMessage(goal_id=goal_id, feedback=feedback))

    def _forget_expired(self) -> None:
        self._goals.forget_expired()

    def _on_arrival(self) -> None:
        """What is known when a request comes counts, not what is when there is time for it."""
        self._forget_expired()

    # -- as part of a node -----------------------------------------------------------------------------------------

    def _may_call_back(self) -> bool:
        return True

    def _end(self) -> None:
        self._goals.forget_all()


__getattr__ = reexported(__name__)
