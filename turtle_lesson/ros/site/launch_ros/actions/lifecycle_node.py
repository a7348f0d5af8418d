"""`LifecycleNode` and `LifecycleTransition`: start a managed node, and have managed nodes change their state."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import launch.logging
from launch import Action, EventHandler, LaunchContext, LaunchDescriptionEntity
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
        return [LifecycleTransition(lifecycle_node_names=[self.node_name], transition_ids=steps)]

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


@expose_action("lifecycle_transition")
class LifecycleTransition(Action):
    """Leads managed nodes through transitions, one after the other; each begins when the one before is done."""

    def __init__(
        self,
        *,
        lifecycle_node_names: Iterable[SomeSubstitutionsType],
        transition_ids: Iterable[int | SomeSubstitutionsType],
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__names = [normalize_to_list_of_substitutions(name) for name in lifecycle_node_names]
        self.__ids = [normalize_to_list_of_substitutions(str(i) if isinstance(i, int) else i) for i in transition_ids]
        if not self.__names:
            raise RuntimeError("No lifecycle_node_names provided.")
        if not self.__ids:
            raise RuntimeError("No transition_ids provided.")

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type, dict[str, Any]]:
        """Its arguments from nested `lifecycle_node` and `transition` tags."""
        _, kwargs = super().parse(entity, parser)
        nodes = entity.get_attr("lifecycle_node", data_type=list[Entity])
        steps = entity.get_attr("transition", data_type=list[Entity])
        kwargs["lifecycle_node_names"] = [parser.parse_substitution(node.get_attr("name")) for node in nodes]
        kwargs["transition_ids"] = [parser.parse_substitution(step.get_attr("id")) for step in steps]
        return cls, kwargs

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Ask for the first, and prepare the others."""
        names = [perform_substitutions(context, name) for name in self.__names]
        ids = [int(perform_substitutions(context, step)) for step in self.__ids]
        return [entity for name in names for entity in _chain(name, ids)]


_GOALS = {
    Transition.TRANSITION_CONFIGURE: "inactive",
    Transition.TRANSITION_CLEANUP: "unconfigured",
    Transition.TRANSITION_ACTIVATE: "active",
    Transition.TRANSITION_DEACTIVATE: "inactive",
}
"""Where a transition leads if it succeeds; all others lead to `finalized`."""


def _chain(name: str, ids: list[int]) -> list[LaunchDescriptionEntity]:
    """The handlers for one node's transitions, and the event that begins the first."""
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
