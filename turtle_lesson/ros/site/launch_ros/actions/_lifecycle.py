"""Managed nodes: `LifecycleNode`, the events that it emits and carries out, and their handler."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

import launch.logging
from launch import Event, EventHandler, LaunchContext, LaunchDescriptionEntity
from launch._entities import SomeEntitiesType, SomeSubstitutionsType
from launch._tags import typed
from launch.actions import EmitEvent, OpaqueFunction, RegisterEventHandler
from launch.frontend import expose_action
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from lifecycle_msgs.msg import State, Transition

from ._nodes import Node

__all__ = ["LifecycleNode"]


def _constants(message: Any, *beginnings: str) -> dict[int, str]:
    """The numbers of a message's constants with these beginnings, and the rest of their names."""
    names = [(begin, name) for begin in beginnings for name in dir(message) if name.startswith(begin)]
    return dict(sorted((getattr(message, name), name.removeprefix(begin).lower()) for begin, name in names))


class ChangeState(Event):
    """The nodes that match are asked to make a transition, such as `Transition.TRANSITION_CONFIGURE`.

    Raises RuntimeError if there is no such transition.
    """

    name = "launch_ros.events.lifecycle.ChangeState"
    valid_states: ClassVar = _constants(State, "PRIMARY_STATE_", "TRANSITION_STATE_")
    valid_transitions: ClassVar = {
        number: f"transition_{name}"
        for number, name in _constants(Transition, "TRANSITION_").items()
        if number <= Transition.TRANSITION_ON_DEACTIVATE_ERROR
    }

    def __init__(self, *, lifecycle_node_matcher: Callable[[LifecycleNode], bool], transition_id: int) -> None:
        if transition_id not in self.valid_transitions:
            raise RuntimeError(
                f"expected transition_id to be one of {list(self.valid_transitions)}, but got '{transition_id}'"
            )
        self.lifecycle_node_matcher = lifecycle_node_matcher
        self.transition_id = transition_id


class StateTransition(Event):
    """A managed node has gone from one state to another, as its lifecycle_msgs/msg/TransitionEvent says."""

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: LifecycleNode, msg: Any) -> None:
        self.action = action
        self.msg = msg

    @property
    def timestamp(self) -> int:
        """When, in ns."""
        return int(self.msg.timestamp)

    @property
    def transition(self) -> str:
        """The transition's name, such as `configure`."""
        return str(self.msg.transition.label)

    @property
    def start_state(self) -> str:
        """The state that it was in, such as `unconfigured`."""
        return str(self.msg.start_state.label)

    @property
    def goal_state(self) -> str:
        """The state that it is in now."""
        return str(self.msg.goal_state.label)


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Matches the action of the node with this full name; a name without a slash before it gets one."""
    wanted = node_name if node_name.startswith("/") else f"/{node_name}"

    def matches(action: Any) -> bool:
        return isinstance(action, Node) and action.node_name == wanted

    return matches


class OnStateTransition(EventHandler):
    """Gives its entities when a transition, such as `configure`, of a node (None: any) fits all that is given.

    A matcher, which is a function of the event, decides alone.
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

    With `autostart` it is configured and activated at once. `current_state` is the one that it was last heard to be in.
    """

    _tag: ClassVar = {**Node._tag, "autostart": typed("autostart", bool)}

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType,
        autostart: bool | SomeSubstitutionsType = False,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.is_autostart = normalize_to_list_of_substitutions(
            str(autostart) if isinstance(autostart, bool) else autostart
        )
        self.current_state = ChangeState.valid_states[State.PRIMARY_STATE_UNKNOWN]

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
        starts_by_itself = perform_substitutions(context, self.is_autostart).lower() in {"true", "1"}
        return [*(entities or []), *(_start(self.node_name) if starts_by_itself else [])]

    def _changed(self, context: LaunchContext, msg: Any) -> None:
        self.current_state = ChangeState.valid_states.get(msg.goal_state.id, msg.goal_state.label)
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


def _start(name: str) -> list[LaunchDescriptionEntity]:
    """What configures a node, and activates it when it has been configured."""
    matcher = matches_node_name(name)
    configure, activate = (
        EmitEvent(event=ChangeState(lifecycle_node_matcher=matcher, transition_id=step))
        for step in (Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE)
    )

    def is_configured(event: Event) -> bool:
        return isinstance(event, StateTransition) and matcher(event.action) and event.goal_state == "inactive"

    configured = OnStateTransition(matcher=is_configured, entities=[activate], handle_once=True)
    return [RegisterEventHandler(configured), configure]
