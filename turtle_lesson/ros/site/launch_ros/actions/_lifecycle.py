"""Managed nodes: `LifecycleNode`, the events that it emits and carries out, and their handler."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

import launch.logging
from launch import Event, EventHandler, LaunchContext, LaunchDescriptionEntity
from launch._entities import SomeEntitiesType, SomeSubstitutionsType, text_of
from launch.actions import EmitEvent, RegisterEventHandler
from launch.frontend import attribute, expose_action
from lifecycle_msgs.msg import Transition, TransitionEvent

from ._nodes import Node

__all__ = ["LifecycleNode"]


class ChangeState(Event):
    """The nodes that match are asked to make a transition, such as `Transition.TRANSITION_CONFIGURE`.

    Raises RuntimeError if there is no such transition.
    """

    valid_transitions: ClassVar = {
        getattr(Transition, name): name.lower()
        for name in dir(Transition)
        if name.startswith("TRANSITION_") and getattr(Transition, name) <= Transition.TRANSITION_ON_DEACTIVATE_ERROR
    }

    def __init__(self, *, lifecycle_node_matcher: Callable[[LifecycleNode], bool], transition_id: int) -> None:
        if transition_id not in self.valid_transitions:
            known = sorted(self.valid_transitions)
            raise RuntimeError(f"expected transition_id to be one of {known}, but got '{transition_id}'")
        self.lifecycle_node_matcher = lifecycle_node_matcher
        self.transition_id = transition_id


class StateTransition(Event):
    """A managed node has gone from one state to another, with the names of the transition and of both states."""

    def __init__(self, *, action: LifecycleNode, msg: TransitionEvent) -> None:
        self.action = action
        self.msg = msg
        self.transition: str = msg.transition.label
        self.start_state: str = msg.start_state.label
        self.goal_state: str = msg.goal_state.label


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Matches the action of the node with this full name; a name without a slash before it gets one."""
    wanted = node_name if node_name.startswith("/") else f"/{node_name}"
    return lambda action: isinstance(action, Node) and action.node_name == wanted


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
        if not isinstance(target_lifecycle_node, LifecycleNode | None):
            raise RuntimeError('OnStateTransition requires a "LifecycleNode" action as the target')

        def fits(event: Event) -> bool:
            return (
                isinstance(event, StateTransition)
                and target_lifecycle_node in (None, event.action)
                and transition in (None, event.transition)
                and start_state in (None, event.start_state)
                and goal_state in (None, event.goal_state)
            )

        super().__init__(matcher=matcher or fits, entities=entities, **kwargs)


@expose_action("lifecycle_node")
class LifecycleNode(Node):
    """Starts a managed node; carries out ChangeState events for it and emits its StateTransition events.

    With `autostart` it is configured and activated at once.
    """

    _tag: ClassVar = {**Node._tag, "autostart": attribute("autostart", bool, optional=True)}

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType,
        autostart: bool | SomeSubstitutionsType = False,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.__autostart = str(autostart) if isinstance(autostart, bool) else autostart

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Have the node started, and listen to it."""
        super().execute(context)
        helper = context._host.ros_helper

        def is_asked(event: Event) -> bool:
            return isinstance(event, ChangeState) and event.lifecycle_node_matcher(self)

        def change_state(event: ChangeState, context: LaunchContext) -> None:
            def answered(success: bool) -> None:
                if not success:
                    transition = ChangeState.valid_transitions[event.transition_id]
                    launch.logging.get_logger("launch_ros.actions.lifecycle_node").error(
                        f"Failed to make transition '{transition}' for LifecycleNode '{self.node_name}'"
                    )

            helper.change_state(self.node_name, event.transition_id, answered)

        helper.watch(self.node_name, lambda msg: context.emit_event_sync(StateTransition(action=self, msg=msg)))
        context.register_event_handler(EventHandler(matcher=is_asked, entities=change_state))
        if text_of(context, self.__autostart).lower() not in {"true", "1"}:
            return None
        matcher = matches_node_name(self.node_name)
        configure, activate = (
            EmitEvent(event=ChangeState(lifecycle_node_matcher=matcher, transition_id=step))
            for step in (Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE)
        )
        configured = OnStateTransition(
            target_lifecycle_node=self, goal_state="inactive", entities=[activate], handle_once=True
        )
        return [RegisterEventHandler(configured), configure]
