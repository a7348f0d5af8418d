"""Action servers: the side that reaches goals.

As in rclpy, a server takes goals, cancel requests and requests for results in its callback group; but the execute
callback is a task of its own, in no group: in a MultiThreadedExecutor it runs beside everything, and in a single-threaded
one it holds up everything, the cancelling of its own goal included, unless it is an `async def` that awaits.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from contextlib import suppress
from enum import Enum
from typing import Any

from action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray

from turtle_lesson.ros.distro import GOALS_EXPIRE_AFTER_THEIR_END
from turtle_lesson.ros.rmw.trace import Callback
from turtle_lesson.ros.runtime.world import current_world
from turtle_lesson.ros.sim.errors import print_error
from turtle_lesson.ros.sim.simulation import NANOSECONDS

from .._entity import name_of
from ..callback_groups import CallbackGroup
from ..exceptions import RCLError
from ..node import Node
from ..qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default
from ._endpoints import TOPICS, ActionEndpoint, call_back
from ._goals import GoalEvent, ServerGoalHandle, goals_to_cancel, key_of


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

    _waiting = True  # it may always call something of the program's own

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
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_goal_callback(goal_callback)
        self.register_cancel_callback(cancel_callback)
        self.register_execute_callback(execute_callback)
        self._goals: dict[bytes, ServerGoalHandle] = {}
        self._result_timeout = round(result_timeout * NANOSECONDS)
        self._records: dict[str, Callback] = {}
        profiles = (
            goal_service_qos_profile,
            cancel_service_qos_profile,
            result_service_qos_profile,
            feedback_pub_qos_profile,
            status_pub_qos_profile,
        )
        super().__init__("server", node, action_type, action_name, callback_group, profiles)

    def _make_part(self, kind: str, part_type: Any, name: str, profile: QoSProfile) -> tuple[Any, Any]:
        node, group = self._node, self.callback_group
        if kind in TOPICS:
            return node.create_publisher(part_type, name, profile), None
        service = node.create_service(part_type, name, None, qos_profile=profile, callback_group=group)  # type: ignore[arg-type]
        return service, service._server

    @property
    def action_type(self) -> Any:
        """The action's class."""
        return self._action_type

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

    def _arrive(self) -> None:
        """What is known when a request comes counts, not what is when there is time for it."""
        self._forget_expired()
        super()._arrive()

    async def execute(self, taken_data: dict[str, Any]) -> None:
        """Do what the requests ask for."""
        if "goal" in taken_data:
            await self._execute_goal_request(taken_data["goal"])
        if "cancel" in taken_data:
            await self._execute_cancel_request(taken_data["cancel"])
        if "result" in taken_data:
            self._execute_result_request(taken_data["result"])

    async def _execute_goal_request(self, request: Any) -> None:
        message, logger = request.message, self._node.get_logger()
        info, key = GoalInfo(goal_id=message.goal_id), key_of(message.goal_id)
        handle = None
        if key not in self._goals and await self._accepts(GoalResponse, self._goal_callback, message.goal):
            info.stamp = self._node.get_clock().now().to_msg()
            if key in self._goals:  # another one of the same number was accepted while the goal callback decided
                logger.error(f"Failed to accept new goal with ID {message.goal_id.uuid}: goal ID already exists")
            else:
                handle = self._goals[key] = ServerGoalHandle(self, info, message.goal)
        accepted = handle is not None
        request.answer(self._action_type.Impl.SendGoalService.Response(accepted=accepted, stamp=info.stamp))
        if handle is not None:
            self._publish_status()
            await call_back("handle_accepted_callback", self._handle_accepted_callback, handle)

    async def _accepts(self, kind: type[Enum], callback: Callable[[Any], Any], argument: Any) -> bool:
        """Whether a callback of the program's answers with ACCEPT."""
        of_goals = kind is GoalResponse
        response = await call_back("goal_callback" if of_goals else "cancel_callback", callback, argument)
        if not isinstance(response, kind):
            what, refused = ("Goal request", "goal") if of_goals else ("Cancel", "cancel request")
            text = f"{what} callback did not return a {kind.__name__} type. Rejecting {refused}."
            self._node.get_logger().warning(text)
        return response is kind["ACCEPT"]

    async def _execute_cancel_request(self, request: Any) -> None:
        response = self._action_type.Impl.CancelGoalService.Response()
        response.return_code, handles = goals_to_cancel(request.message.goal_info, self._goals)
        for handle in handles:
            if await self._accepts(CancelResponse, self._cancel_callback, handle):
                with suppress(RCLError):  # it has ended meanwhile
                    handle._update_state(GoalEvent.CANCEL_GOAL)
                    response.goals_canceling.append(handle._goal_info)
        request.answer(response)

    def _execute_result_request(self, request: Any) -> None:
        handle = self._goals.get(key_of(request.message.goal_id))
        if handle is None:
            request.answer(self._action_type.Impl.GetResultService.Response(status=GoalStatus.STATUS_UNKNOWN))
        elif handle._response is None:
            handle._asked.append(request)
        else:
            request.answer(handle._response)

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
        goal_handle._is_executing = True
        executor.create_task(self._execute_goal, callback, goal_handle, self._node._ros_simulation.now)

    async def _execute_goal(
        self, execute_callback: Callable[..., Any], goal_handle: ServerGoalHandle, ready: int
    ) -> None:
        logger, simulation = self._node.get_logger(), self._node._ros_simulation
        simulation.sleep_until(simulation.now + OVERHEAD)
        record, begun = self._record_of(execute_callback), (ready, simulation.now)
        if record is not None:
            record.open.append(begun)
        try:
            result = await call_back("execute_callback", execute_callback, goal_handle)
        except Exception as error:
            result = self._action_type.Result()
            logger.error(f"Error raised in execute callback: {error}")
            print_error(error)
        finally:
            if record is not None:
                record.end_run(begun, simulation.now)
        if goal_handle.is_active:
            logger.warning(f"Goal state not set, assuming aborted. Goal ID: {goal_handle.goal_id.uuid}")
            goal_handle.abort()
        try:
            response = self._action_type.Impl.GetResultService.Response(status=goal_handle.status, result=result)
        except AssertionError as error:
            name = self._action_type.__name__
            error.add_note(
                f"The execute callback of {self._name} returned {result!r}, where a {name}.Result is expected: end it "
                f"with `return {name}.Result(…)`, on every way out."
            )
            raise
        goal_handle._finish(response)

    def _record_of(self, callback: Callable[..., Any]) -> Callback | None:
        """Where the runs of an execute callback are noted, if the world keeps a trace of them."""
        entry, trace = self._node._ros_entry, self._node._ros_graph.trace
        if trace is None or entry.hidden:
            return None
        name = name_of(callback)
        if name not in self._records:
            awaits = inspect.iscoroutinefunction(callback)
            self._records[name] = Callback(entry.full_name, name, "action", self._name, 0, entry.process.pid, awaits)
            trace.callbacks.append(self._records[name])
        return self._records[name]

    def notify_goal_done(self) -> None:
        """A goal has ended: look which ones have expired. The server does that for itself, too."""
        self._forget_expired()

    def _publish_status(self) -> None:
        self._forget_expired()
        goals = [goal._for_all for goal in self._goals.values()]
        self._parts["status"].publish(GoalStatusArray(status_list=goals))

    def _publish_feedback(self, goal_id: Any, feedback: Any) -> None:
        self._parts["feedback"].publish(self._action_type.Impl.FeedbackMessage(goal_id=goal_id, feedback=feedback))

    def _keep_until(self, accepted_at: int) -> int:
        """When (ns) a goal that ends now is to be forgotten."""
        after_its_end = current_world().release.has(GOALS_EXPIRE_AFTER_THEIR_END)
        return self._result_timeout + (self._node._ros_simulation.now if after_its_end else accepted_at)

    def _forget_expired(self) -> None:
        """Forget the goals whose time is over, unless their execute callback still runs.

        The real server does that with a timer (rcl_action's action_server.c). Here it looks whenever something is asked:
        nobody can tell the difference, and nothing keeps a world awake in which nothing happens any more.
        """
        now = self._node._ros_simulation.now
        for key, goal in list(self._goals.items()):
            if goal._forgotten_at < now and not goal._is_executing:
                self._goals.pop(key).destroy()

    def destroy(self) -> None:
        """Leave the action: goals that go on are not followed any more."""
        super().destroy()
        for handle in self._goals.values():
            handle.destroy()
        self._goals.clear()
