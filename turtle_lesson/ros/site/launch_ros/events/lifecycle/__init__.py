"""Events about managed nodes: asking for a transition, and hearing of one (facts: launch_ros.events.lifecycle)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from launch import Event
from lifecycle_msgs.msg import State, Transition

if TYPE_CHECKING:
    from ...actions import LifecycleNode

__all__ = ["ChangeState", "StateTransition"]

_STATES = ("unknown", "unconfigured", "inactive", "active", "finalized")
_BETWEEN = ("configuring", "cleaningup", "shuttingdown", "activating", "deactivating", "errorprocessing")
_TRANSITIONS = (
    "create", "configure", "cleanup", "activate", "deactivate", "unconfigured_shutdown", "inactive_shutdown",
    "active_shutdown", "destroy",
)  # fmt: skip
_RESULTS = ("success", "failure", "error")


def _states() -> dict[int, str]:
    known = {getattr(State, f"PRIMARY_STATE_{name.upper()}"): name for name in _STATES}
    return known | {getattr(State, f"TRANSITION_STATE_{name.upper()}"): name for name in _BETWEEN}


def _transitions() -> dict[int, str]:
    known = {getattr(Transition, f"TRANSITION_{name.upper()}"): f"transition_{name}" for name in _TRANSITIONS}
    for step in ("configure", "cleanup", "activate", "deactivate"):
        for result in _RESULTS:
            name = f"ON_{step}_{result}"
            if hasattr(Transition, f"TRANSITION_{name.upper()}"):
                known[getattr(Transition, f"TRANSITION_{name.upper()}")] = f"transition_{name.lower()}"
    return known


class ChangeState(Event):
    """The nodes that match are asked to make a transition, such as `Transition.TRANSITION_CONFIGURE`.

    Raises:
        RuntimeError: if there is no such transition.
    """

    name = "launch_ros.events.lifecycle.ChangeState"
    valid_states = _states()
    valid_transitions = _transitions()

    def __init__(self, *, lifecycle_node_matcher: Callable[[LifecycleNode], bool], transition_id: int) -> None:
        if transition_id not in self.valid_transitions:
            raise RuntimeError(
                f"expected transition_id to be one of {list(self.valid_transitions)}, but got '{transition_id}'"
            )
        self.__matcher = lifecycle_node_matcher
        self.__transition_id = transition_id

    @property
    def lifecycle_node_matcher(self) -> Callable[[LifecycleNode], bool]:
        """Says of an action whether it is meant."""
        return self.__matcher

    @property
    def transition_id(self) -> int:
        """The transition."""
        return self.__transition_id


class StateTransition(Event):
    """A managed node has gone from one state to another."""

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: LifecycleNode, msg: Any) -> None:
        self.__action = action
        self.__msg = msg

    @property
    def action(self) -> LifecycleNode:
        """The node's action."""
        return self.__action

    @property
    def msg(self) -> Any:
        """The node's message, a lifecycle_msgs/msg/TransitionEvent."""
        return self.__msg

    @property
    def timestamp(self) -> int:
        """When, in ns."""
        return int(self.__msg.timestamp)

    @property
    def transition(self) -> str:
        """The transition's name, such as `configure`."""
        return str(self.__msg.transition.label)

    @property
    def start_state(self) -> str:
        """The state that it was in, such as `unconfigured`."""
        return str(self.__msg.start_state.label)

    @property
    def goal_state(self) -> str:
        """The state that it is in now."""
        return str(self.__msg.goal_state.label)
