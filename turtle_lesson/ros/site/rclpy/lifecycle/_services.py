"""The five services through which a managed node is asked about its states, and told to change them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..callback_groups import CallbackGroup
from ..exceptions import RCLError
from ..node import Node
from ._states import StateMachine, Transition


class LifecycleServices:
    """Made by a managed node for itself. `change(transition_id)` does a transition, and returns whether it succeeded."""

    def __init__(self, node: Any, machine: StateMachine, change: Callable[[int], bool], group: CallbackGroup) -> None:
        from lifecycle_msgs.srv import ChangeState, GetAvailableStates, GetAvailableTransitions, GetState

        self._machine = machine
        self._change = change
        for kind, name, callback in (
            (ChangeState, "change_state", self._change_state),
            (GetState, "get_state", self._get_state),
            (GetAvailableStates, "get_available_states", self._get_available_states),
            (GetAvailableTransitions, "get_available_transitions", self._get_available_transitions),
            (GetAvailableTransitions, "get_transition_graph", self._get_transition_graph),
        ):
            Node.create_service(node, kind, f"~/{name}", callback, callback_group=group)

    def _change_state(self, request: Any, response: Any) -> Any:
        number = request.transition.id
        if request.transition.label:
            try:
                number = self._machine.get_transition_by_label(request.transition.label)
            except RCLError:
                response.success = False
                return response
        response.success = self._change(number)
        return response

    def _get_state(self, request: Any, response: Any) -> Any:
        response.current_state.id, response.current_state.label = self._machine.current_state
        return response

    def _get_available_states(self, request: Any, response: Any) -> Any:
        from lifecycle_msgs.msg import State

        response.available_states = [State(id=each.id, label=each.label) for each in self._machine.available_states]
        return response

    def _get_available_transitions(self, request: Any, response: Any) -> Any:
        response.available_transitions = [_description(each) for each in self._machine.available_transitions]
        return response

    def _get_transition_graph(self, request: Any, response: Any) -> Any:
        response.available_transitions = [_description(each) for each in self._machine.transition_graph]
        return response


def _description(transition: Transition) -> Any:
    from lifecycle_msgs.msg import TransitionDescription

    message = TransitionDescription()
    message.transition.id, message.transition.label = transition.id, transition.label
    message.start_state.id, message.start_state.label = transition.start
    message.goal_state.id, message.goal_state.label = transition.goal
    return message
