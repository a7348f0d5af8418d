"""Managed nodes: `LifecycleNode`, the events that it emits and carries out, and their handler."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import launch.logging
from launch import Event, EventHandler, LaunchContext, LaunchDescriptionEntity
from launch._entities import SomeEntitiesType, SomeSubstitutionsType
from launch.actions import EmitEvent, OpaqueFunction, RegisterEventHandler
from launch.frontend import Entity, Parser, expose_action
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from lifecycle_msgs.msg import State, Transition

from .actions._nodes import Node

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


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Matches the action of the node with this full name; a name without a slash before it gets one."""
    wanted = node_name if node_name.startswith("/") else f"/{node_name}"

    def matches(action: Any) -> bool:
        return isinstance(action, Node) and action.node_name == wanted

    return matches


class OnStateTransition(EventHandler):
    """Gives its entities when a managed node's transition fits all that is given.

    Args:
        entities: what is visited then.
        target_lifecycle_node: the node, or None for any.
        transition: the transition's name, such as `configure`.
        start_state: the state that it comes from, such as `unconfigured`.
        goal_state: the state that it comes to.
        matcher: a function of the event; if it is given, it alone decides.
    """

    def __init__(
        self,
        *,
        entities: SomeEntitiesType,
        target_lifecycle_node: LifecycleNode | None = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        matcher: Callable[[Event], bool] | None = None,
        **kwargs: Any,
    ) -> None:
        if target_lifecycle_node is not None and not isinstance(target_lifecycle_node, LifecycleNode):
            raise RuntimeError(
                'OnStateTransition requires a "LifecycleNode" action as the target, '
                "target_lifecycle_node is not a node type."
            )
        wanted = {"transition": transition, "start_state": start_state, "goal_state": goal_state}

        def fits(event: Event) -> bool:
            return (
                isinstance(event, StateTransition)
                and target_lifecycle_node in (None, event.action)
                and all(value in (None, getattr(event, name)) for name, value in wanted.items())
            )

        super().__init__(matcher=matcher or fits, entities=entities, **kwargs)


@expose_action("lifecycle_node")
class LifecycleNode(Node):
    """Starts a managed node; carries out ChangeState events for it and emits its StateTransition events.

    Args:
        name: the node's name, which must be given.
        namespace: its namespace.
        autostart: whether it is configured and activated at once.
    """

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType,
        autostart: bool | SomeSubstitutionsType = False,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.__autostart = normalize_to_list_of_substitutions(
            str(autostart) if isinstance(autostart, bool) else autostart
        )
        self.__current_state = ChangeState.valid_states[State.PRIMARY_STATE_UNKNOWN]

    @classmethod
    def parse(cls, entity: Entity, parser: Parser, ignore: list[str] | None = None) -> tuple[type, dict[str, Any]]:
        """Its arguments: a node's, and `autostart`."""
        _, kwargs = super().parse(entity, parser, ignore)
        autostart = entity.get_attr("autostart", data_type=bool, optional=True)
        if autostart is not None:
            kwargs["autostart"] = parser.parse_if_substitutions(autostart)
        return cls, kwargs

    @property
    def is_autostart(self) -> list[Any]:
        """Whether it is configured and activated at once, as substitutions."""
        return self.__autostart

    @property
    def current_state(self) -> str:
        """The state that it was last heard to be in, such as `inactive`."""
        return self.__current_state

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Have the node started, and listen to it."""
        entities = super().execute(context)
        if "unspecified" in self.node_name:
            raise RuntimeError("node_name unexpectedly incomplete for lifecycle node")
        if context._host is None:
            return entities
        context._host.ros_helper().watch(self.node_name, lambda msg: self._changed(context, msg))
        context.register_event_handler(
            EventHandler(
                matcher=lambda event: isinstance(event, ChangeState) and event.lifecycle_node_matcher(self),
                entities=[OpaqueFunction(function=self._change_state)],
            )
        )
        return [*(entities or []), *self._start_actions(context)]

    def _start_actions(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        if perform_substitutions(context, self.__autostart).lower() not in {"true", "1"}:
            return []
        steps = [Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE]
        return _chain(self.node_name, steps)

    def _changed(self, context: LaunchContext, msg: Any) -> None:
        self.__current_state = ChangeState.valid_states.get(msg.goal_state.id, msg.goal_state.label)
        context.emit_event_sync(StateTransition(action=self, msg=msg))

    def _change_state(self, context: LaunchContext) -> None:
        event: ChangeState = context.locals.event
        assert context._host is not None

        def answered(success: bool) -> None:
            if not success:
                transition = ChangeState.valid_transitions[event.transition_id]
                launch.logging.get_logger("launch_ros.actions.lifecycle_node").error(
                    f"Failed to make transition '{transition}' for LifecycleNode '{self.node_name}'"
                )

        context._host.ros_helper().change_state(self.node_name, event.transition_id, answered)


_GOALS = {
    Transition.TRANSITION_CONFIGURE: "inactive",
    Transition.TRANSITION_CLEANUP: "unconfigured",
    Transition.TRANSITION_ACTIVATE: "active",
    Transition.TRANSITION_DEACTIVATE: "inactive",
}
"""Where a transition leads if it succeeds; all others lead to `finalized`."""


def _chain(name: str, ids: list[int]) -> list[LaunchDescriptionEntity]:
    """The handlers that lead a node through transitions, one after the other, and the event that begins the first."""
    matcher = matches_node_name(name)

    def ask(step: int) -> EmitEvent:
        return EmitEvent(event=ChangeState(lifecycle_node_matcher=matcher, transition_id=step))

    def reached(before: int) -> Any:
        goal = _GOALS.get(before, "finalized")
        return lambda event: isinstance(event, StateTransition) and matcher(event.action) and event.goal_state == goal

    handlers: list[LaunchDescriptionEntity] = [
        RegisterEventHandler(OnStateTransition(matcher=reached(before), entities=[ask(step)], handle_once=True))
        for before, step in pairwise(ids)
    ]
    return [*handlers, ask(ids[0])]
