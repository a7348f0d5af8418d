"""Action clients: the side that has goals."""

from __future__ import annotations

from collections.abc import Callable
from types import GenericAlias
from typing import Any
from weakref import WeakValueDictionary

from action_msgs.msg import GoalStatus
from action_msgs.srv import CancelGoal

from turtle_lesson.ros.sim.errors import NeverWakes
from turtle_lesson.ros.sim.strand import running_strand

from .._blocking import drives_the_simulation, wait_until
from .._deadlock import Words, why_never_answered, why_nobody_offers
from .._hints import shown
from ..callback_groups import CallbackGroup
from ..client import POLL, Client
from ..node import Node
from ..qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default
from ..task import Future
from ._endpoints import TOPICS, ActionEndpoint, call_back, new_goal_id
from ._goals import ACTIVE, key_of

ASK = {
    "goal": "action_client.send_goal_async(goal)",
    "cancel": "goal_handle.cancel_goal_async()",
    "result": "goal_handle.get_result_async()",
}
"""What to do instead of a synchronous call of each service behind an action."""
SUFFIX = "/_action/send_goal"
FEEDBACK = QoSProfile(depth=10)


class ActionClient(ActionEndpoint):
    """Sends goals to an action's server.

    Args:
        node: whose client it is.
        action_type: the action's class, such as example_interfaces.action.Fibonacci.
        action_name: its name.
        callback_group: for the taking of answers and feedback; the node's default one if none is given.
    """

    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        *,
        callback_group: CallbackGroup | None = None,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_sub_qos_profile: QoSProfile = FEEDBACK,
        status_sub_qos_profile: QoSProfile = qos_profile_action_status_default,
    ) -> None:
        self._goal_ids: dict[int, Any] = {}
        self._goal_handles: WeakValueDictionary[bytes, ClientGoalHandle] = WeakValueDictionary()
        self._feedback_callbacks: dict[bytes, Callable[[Any], Any]] = {}
        profiles = (
            goal_service_qos_profile,
            cancel_service_qos_profile,
            result_service_qos_profile,
            feedback_sub_qos_profile,
            status_sub_qos_profile,
        )
        super().__init__("client", node, action_type, action_name, callback_group, profiles)
        self._clients: list[Client] = [self._parts[kind] for kind in ASK]
        self._goal_client, self._cancel_client, self._result_client = self._clients

    def _make_part(self, kind: str, part_type: Any, name: str, profile: QoSProfile) -> tuple[Any, Any]:
        node, group = self._node, self.callback_group
        if kind in TOPICS:
            subscription = node.create_subscription(part_type, name, None, profile, callback_group=group)  # type: ignore[arg-type]
            return subscription, subscription._reader
        client = node.create_client(part_type, name, qos_profile=profile, callback_group=group)
        client._words = Words("action client", "action server", ASK[kind], "ActionClient")
        return client, client._end

    def server_is_ready(self) -> bool:
        """Whether somebody offers the action now."""
        self._check_alive()
        has_topics = all(self._arrived[kind].topic.writers for kind in TOPICS)
        return has_topics and all(client._servers() for client in self._clients)

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Wait until a node offers the action; False if none does within the timeout (s). None waits forever."""
        what = f"wait_for_server for {self._name}"
        return wait_until(self.server_is_ready, timeout_sec, POLL, self._node.context, what)

    def send_goal_async(
        self, goal: Any, feedback_callback: Callable[[Any], Any] | None = None, goal_uuid: Any = None
    ) -> Future:
        """Send a goal; the future will have a ClientGoalHandle, once the server has accepted or rejected it.

        Args:
            goal: an action_type.Goal.
            feedback_callback: called with each feedback message, whose `feedback` is an action_type.Feedback.
            goal_uuid: the goal's number, a unique_identifier_msgs.msg.UUID; a new one if none is given.

        Raises TypeError for anything but a goal.
        """
        self._check_goal(goal)
        request = self._action_type.Impl.SendGoalService.Request(goal=goal)
        request.goal_id = new_goal_id() if goal_uuid is None else goal_uuid
        future = self._goal_client.call_async(request)
        self._goal_ids[future._request_number] = request.goal_id
        if feedback_callback is not None:
            self._feedback_callbacks[key_of(request.goal_id)] = feedback_callback
        return future

    def send_goal(self, goal: Any, **kwargs: Any) -> Any:
        """Send a goal and wait for its end; returns its `status` and `result`. Keywords are those of send_goal_async.

        Works where another thread takes the answers, and in a plain notebook cell. Where nobody ever could, it raises
        NeverWakes, which says why, instead of hanging as a real one does.
        """
        self._check_goal(goal)
        return self._wait(self._goal_client, "send_goal", lambda: self.send_goal_async(goal, **kwargs)).get_result()

    def _check_goal(self, goal: Any) -> None:
        if not isinstance(goal, self._action_type.Goal):
            name = f"{self._action_type.__name__}.Goal"
            raise TypeError(f"a goal of {self._action_name} is of type {name}, got {shown(goal)}: try {name}(…)")

    @drives_the_simulation
    def _wait(self, client: Client, what: str, ask: Callable[[], Future]) -> Any:
        """Ask, and wait for the answer as `Client.call` does."""
        strand = running_strand()
        assert strand is not None
        strand.activity = f"{what} of {self._name}"
        if self.server_is_ready():
            problem = why_never_answered(client, strand)
        else:
            services = self._node._ros_graph.services()
            offered = {
                each.removesuffix(SUFFIX): [kind.removesuffix("_SendGoal") for kind in kinds]
                for each, kinds in services.items()
                if each.endswith(SUFFIX)
            }
            problem = why_nobody_offers("action", self._name, self._action_type._TYPE_NAME, offered)
        if problem:
            raise NeverWakes(f"this {what} of {self._name} can never be answered: {problem}")
        return client._answer_to(ask(), strand)

    async def execute(self, taken_data: dict[str, Any]) -> None:
        """Give the futures their results, and feedback to its callback, in the order of rclpy."""
        if "goal" in taken_data:
            self._take_goal_response(*taken_data["goal"])
        if "cancel" in taken_data:
            self._complete("cancel", *taken_data["cancel"])
        if "result" in taken_data:
            self._complete("result", *taken_data["result"])
        if "feedback" in taken_data:
            message = taken_data["feedback"]
            callback = self._feedback_callbacks.get(key_of(message.goal_id))
            if callback is not None:
                await call_back("feedback_callback", callback, message)
        if "status" in taken_data:
            self._take_status(taken_data["status"])

    def _take_goal_response(self, number: int, response: Any) -> None:
        goal_id = self._goal_ids.pop(number, None)
        handle = ClientGoalHandle(self, goal_id, response)
        if goal_id is not None:
            if not handle.accepted:
                self._feedback_callbacks.pop(key_of(goal_id), None)
            else:
                self._goal_handles[key_of(goal_id)] = handle
        self._complete("goal", number, handle)

    def _complete(self, kind: str, number: int, value: Any) -> None:
        client = self._parts[kind]
        future = client._waiting.pop(number, None)
        if future is not None:
            client._set_result(future, value)
            return
        self._node.get_logger().warning(
            f"Ignoring unexpected {kind} response. There may be more than "
            f"one action server for the action '{self._action_name}'"
        )

    def _take_status(self, message: Any) -> None:
        """Note the states of the goals that are followed."""
        for each in message.status_list:
            handle = self._goal_handles.get(key_of(each.goal_info.goal_id))
            if handle is not None:
                handle._status = each.status
                if each.status not in ACTIVE:
                    del self._goal_handles[key_of(handle.goal_id)]

    @property
    def _waiting(self) -> bool:
        """Whether it may call something of the program's own."""
        return bool(self._feedback_callbacks) or any(client._waiting for client in self._clients)

    def destroy(self) -> None:
        """Leave the action: answers under way are dropped, and no more feedback comes."""
        super().destroy()
        self._feedback_callbacks.clear()


class ClientGoalHandle:
    """A goal, as the client sees it that has sent it. Made by ActionClient."""

    __class_getitem__: Any = classmethod(GenericAlias)  # newer releases: ClientGoalHandle[…] in a hint

    def __init__(self, action_client: ActionClient, goal_id: Any, goal_response: Any) -> None:
        self._action_client = action_client
        self._goal_id = goal_id
        self._goal_response = goal_response
        self._status = GoalStatus.STATUS_UNKNOWN

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ClientGoalHandle) and self._goal_id == other.goal_id

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"ClientGoalHandle <id={self.goal_id.uuid}, accepted={self.accepted}, status={self.status}>"

    @property
    def goal_id(self) -> Any:
        """The goal's number, a unique_identifier_msgs.msg.UUID."""
        return self._goal_id

    @property
    def stamp(self) -> Any:
        """When the server accepted the goal, a builtin_interfaces.msg.Time."""
        return self._goal_response.stamp

    @property
    def accepted(self) -> bool:
        """Whether the server accepted the goal."""
        return self._goal_response.accepted

    @property
    def status(self) -> int:
        """The goal's state as last heard of, one of action_msgs.msg.GoalStatus."""
        return self._status

    def cancel_goal(self) -> Any:
        """Ask to cancel the goal, and wait for the answer. Not for callbacks: see ActionClient.send_goal."""
        client = self._action_client
        return client._wait(client._cancel_client, "cancel_goal", self.cancel_goal_async)

    def cancel_goal_async(self) -> Future:
        """Ask to cancel the goal; the future will have a CancelGoal.Response."""
        request = CancelGoal.Request()
        request.goal_info.goal_id = self.goal_id
        return self._action_client._cancel_client.call_async(request)

    def get_result(self) -> Any:
        """Wait for the goal's end; returns its `status` and `result`. Not for callbacks: see ActionClient.send_goal."""
        client = self._action_client
        return client._wait(client._result_client, "get_result", self.get_result_async)

    def get_result_async(self) -> Future:
        """Ask for the goal's result; the future will have its `status` and `result` when it has ended."""
        client, key = self._action_client, key_of(self.goal_id)
        request = client._action_type.Impl.GetResultService.Request(goal_id=self.goal_id)
        future = client._result_client.call_async(request)
        future.add_done_callback(lambda _: client._feedback_callbacks.pop(key, None))
        return future
