"""`LifecycleNode`: start a managed node."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import launch.logging
from launch import EventHandler, LaunchContext, LaunchDescriptionEntity
from launch.actions import EmitEvent, OpaqueFunction, RegisterEventHandler
from launch.frontend import Entity, Parser, expose_action
from launch.some_types import SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from lifecycle_msgs.msg import State, Transition

from ..event_handlers import OnStateTransition
from ..events.lifecycle import ChangeState, StateTransition
from ..events.matchers import matches_node_name
from .node import Node


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
