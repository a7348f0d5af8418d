"""Managed nodes, their states, and the transitions between them: rcl's default state machine."""

from __future__ import annotations

from collections.abc import Callable
from traceback import extract_tb
from typing import Any, NamedTuple

from turtle_lesson.ros.distro import FORBIDDEN_TRANSITIONS_ARE_LOGGED
from turtle_lesson.ros.runtime.world import current_world
from turtle_lesson.ros.sim.errors import shown_path

from ..callback_groups import CallbackGroup
from ..exceptions import RCLError
from ..impl.rcutils_logger import RcutilsLogger
from ..node import Node
from .managed_entity import LifecycleState, ManagedEntity, TransitionCallbackReturn
from .publisher import LifecyclePublisher

CONFIGURE, CLEANUP, ACTIVATE, DEACTIVATE = 1, 2, 3, 4
HANDLERS = {
    "configuring": "on_configure",
    "cleaningup": "on_cleanup",
    "shuttingdown": "on_shutdown",
    "activating": "on_activate",
    "deactivating": "on_deactivate",
    "errorprocessing": "on_error",
}


class State(NamedTuple):
    """A state: its number and its label."""

    id: int
    label: str


class Transition(NamedTuple):
    """A transition: its number, its label, and the labels of the states that it leads from and to."""

    id: int
    label: str
    start: str
    goal: str


_AT_REST = ["unknown", "unconfigured", "inactive", "active", "finalized"]
_ON_THE_WAY = ["configuring", "cleaningup", "shuttingdown", "activating", "deactivating", "errorprocessing"]
STATES = {label: State(number, label) for number, label in (*enumerate(_AT_REST), *enumerate(_ON_THE_WAY, 10))}


def _outcomes(number: int, state: str, success: str, failure: str, error: str = "errorprocessing") -> list[Transition]:
    """How a state in which a callback runs is left."""
    goals = {"success": success, "failure": failure, "error": error}
    return [Transition(number + i, f"transition_{how}", state, goal) for i, (how, goal) in enumerate(goals.items())]


TRANSITIONS = [
    Transition(1, "configure", "unconfigured", "configuring"),
    *_outcomes(10, "configuring", "inactive", "unconfigured"),
    Transition(2, "cleanup", "inactive", "cleaningup"),
    *_outcomes(20, "cleaningup", "unconfigured", "inactive"),
    Transition(3, "activate", "inactive", "activating"),
    *_outcomes(30, "activating", "active", "inactive"),
    Transition(4, "deactivate", "active", "deactivating"),
    *_outcomes(40, "deactivating", "inactive", "active"),
    *(Transition(5 + i, "shutdown", state, "shuttingdown") for i, state in enumerate(_AT_REST[1:4])),
    *_outcomes(50, "shuttingdown", "finalized", "finalized"),
    *_outcomes(60, "errorprocessing", "unconfigured", "finalized", "finalized"),
]


class StateMachine:
    """Which state a node is in. `notify(start, goal)` is called at each change."""

    def __init__(self, notify: Callable[[State, State], object]) -> None:
        self.current_state = STATES["unconfigured"]
        self._notify = notify

    @property
    def available_transitions(self) -> list[Transition]:
        """The transitions that lead out of the state that it is in."""
        return [each for each in TRANSITIONS if each.start == self.current_state.label]

    def find(self, wanted: int | str) -> Transition | None:
        """The transition of a number or label, if it is possible now; a warning is logged if it is not."""
        for each in self.available_transitions:
            if wanted in (each.id, each.label):
                return each
        RcutilsLogger("rcl_lifecycle").warning(
            f"No transition matching {wanted} found for current state {self.current_state.label}"
        )
        return None

    def trigger(self, wanted: int | str) -> None:
        """Go along the transition of a number or label. Raises RCLError if it is not possible now."""
        transition = self.find(wanted)
        if transition is None:
            error = RCLError("Failed to trigger lifecycle state machine transition: Transition is not registered.")
            possible = ", ".join(f"{each.label} [{each.id}]" for each in self.available_transitions) or "nothing"
            error.add_note(f"The node is {self.current_state.label}; possible from there: {possible}.")
            raise error
        self.current_state = STATES[transition.goal]
        self._notify(STATES[transition.start], self.current_state)


class LifecycleNodeMixin(ManagedEntity):
    """What makes a managed node of a node: `class MyNode(LifecycleNodeMixin, Node)`, both of whose __init__ are called.

    Overriding on_configure and its like replaces what it does by default, which is to ask all managed entities in the
    order in which they were added; `super().on_configure(state)` does that as well.
    """

    default_callback_group: CallbackGroup
    get_logger: Any

    def __init__(
        self, *, enable_communication_interface: bool = True, callback_group: CallbackGroup | None = None
    ) -> None:
        from lifecycle_msgs.msg import TransitionEvent

        self._managed_entities: list[ManagedEntity] = []
        publisher = Node.create_publisher(self, TransitionEvent, "~/transition_event", 10)  # type: ignore[arg-type]

        def notify(start: State, goal: State) -> None:
            event = TransitionEvent()
            event.start_state.id, event.start_state.label = start
            event.goal_state.id, event.goal_state.label = goal
            publisher.publish(event)

        self._state_machine = StateMachine(notify)
        if enable_communication_interface:
            self._ros_offer_services(callback_group or self.default_callback_group)

    def trigger_configure(self) -> TransitionCallbackReturn:
        """Configure the node, which must be unconfigured; raises RCLError if it is not (as its siblings do)."""
        return self._ros_change_state(CONFIGURE)

    def trigger_cleanup(self) -> TransitionCallbackReturn:
        """Clean up the node, which must be inactive."""
        return self._ros_change_state(CLEANUP)

    def trigger_shutdown(self) -> TransitionCallbackReturn:
        """Shut the node down; it stays where it is, but can do nothing any more. RCLError if it is finalized already."""
        if all(each.label != "shutdown" for each in self._state_machine.available_transitions):
            raise RCLError("Shutdown transtion not possible")  # spelt as in rclpy
        return self._ros_change_state("shutdown")

    def trigger_activate(self) -> TransitionCallbackReturn:
        """Activate the node, which must be inactive."""
        return self._ros_change_state(ACTIVATE)

    def trigger_deactivate(self) -> TransitionCallbackReturn:
        """Deactivate the node, which must be active."""
        return self._ros_change_state(DEACTIVATE)

    def _ros_change_state(self, wanted: int | str) -> TransitionCallbackReturn:
        machine = self._state_machine
        before = LifecycleState(label=machine.current_state.label, state_id=machine.current_state.id)
        machine.trigger(wanted)
        outcome = self._ros_call(before)
        if outcome == TransitionCallbackReturn.ERROR:
            self._ros_call(before)
        return outcome

    def _ros_call(self, before: LifecycleState) -> TransitionCallbackReturn:
        """Call what handles the state that the node is in, and leave it. What it raises counts as an error, and is logged."""
        name = HANDLERS[self._state_machine.current_state.label]
        outcome: Any = TransitionCallbackReturn.ERROR
        try:
            outcome = getattr(self, name)(before)
        except Exception as error:
            last = extract_tb(error.__traceback__)[-1]
            what = f"{name} raised {type(error).__name__}: {error}"  # the real rclpy says nothing of it
            place = f"({shown_path(last.filename)}, line {last.lineno})"
            self.get_logger().error(f"{what} {place}. That counts as an error of the transition.")
        if not hasattr(outcome, "to_label"):
            mistake = AttributeError(f"{type(outcome).__name__!r} object has no attribute 'to_label'")
            mistake.add_note(f"{name} returned {outcome!r}; end it with `return TransitionCallbackReturn.SUCCESS`.")
            raise mistake
        self._state_machine.trigger(outcome.to_label())
        return outcome

    def _ros_offer_services(self, group: CallbackGroup) -> None:
        """Have others see and change the state through services, whose names are those of these functions."""
        from lifecycle_msgs import msg, srv

        machine = self._state_machine

        def change_state(request: Any, response: Any) -> Any:
            label, current = request.transition.label, machine.current_state
            wanted = machine.find(label) if label else request.transition
            if wanted is None:
                return response
            try:
                response.success = self._ros_change_state(wanted.id) == TransitionCallbackReturn.SUCCESS
            except RCLError:
                if not current_world().release.has(FORBIDDEN_TRANSITIONS_ARE_LOGGED):
                    raise
                self.get_logger().error(f"Unable to start transition {wanted.id} from current state {tuple(current)}")
            return response

        def get_state(request: Any, response: Any) -> Any:
            response.current_state.id, response.current_state.label = machine.current_state
            return response

        def get_available_states(request: Any, response: Any) -> Any:
            response.available_states = [msg.State(id=each.id, label=each.label) for each in STATES.values()]
            return response

        def get_available_transitions(request: Any, response: Any) -> Any:
            response.available_transitions = [_description(each) for each in machine.available_transitions]
            return response

        def get_transition_graph(request: Any, response: Any) -> Any:
            response.available_transitions = [_description(each) for each in TRANSITIONS]
            return response

        for kind, callback in (
            (srv.ChangeState, change_state),
            (srv.GetState, get_state),
            (srv.GetAvailableStates, get_available_states),
            (srv.GetAvailableTransitions, get_available_transitions),
            (srv.GetAvailableTransitions, get_transition_graph),
        ):
            name = f"~/{callback.__name__}"
            Node.create_service(self, kind, name, callback, callback_group=group)  # type: ignore[arg-type]

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        """Have an entity go through the node's transitions, too."""
        if not isinstance(entity, ManagedEntity):
            raise TypeError(f"Expected a rclpy.lifecycle.ManagedEntity instance, got {entity!r}.")
        if entity not in self._managed_entities:
            self._managed_entities.append(entity)

    def _ros_go_along(self, name: str, state: LifecycleState) -> TransitionCallbackReturn:
        for entity in list(self._managed_entities):
            outcome = getattr(entity, name)(state)
            if outcome != TransitionCallbackReturn.SUCCESS:
                return outcome
        return TransitionCallbackReturn.SUCCESS

    def create_lifecycle_publisher(self, *args: Any, **kwargs: Any) -> LifecyclePublisher:
        """As `create_publisher`; but the publisher only publishes while the node is active."""
        publisher: Any = Node.create_publisher(self, *args, **kwargs, publisher_class=LifecyclePublisher)  # type: ignore[arg-type]
        self.add_managed_entity(publisher)
        return publisher

    def destroy_lifecycle_publisher(self, publisher: LifecyclePublisher) -> bool:
        """Take such a publisher away; False if it is not this node's."""
        if publisher in self._managed_entities:
            self._managed_entities.remove(publisher)
        return Node.destroy_publisher(self, publisher)  # type: ignore[arg-type]


class LifecycleNode(LifecycleNodeMixin, Node):
    """A managed node. `keywords` are those of `rclpy.node.Node`."""

    def __init__(self, node_name: str, *, enable_communication_interface: bool = True, **kwargs: Any) -> None:
        Node.__init__(self, node_name, **kwargs)
        LifecycleNodeMixin.__init__(self, enable_communication_interface=enable_communication_interface)


def _description(transition: Transition) -> Any:
    from lifecycle_msgs.msg import TransitionDescription

    message = TransitionDescription()
    message.transition.id, message.transition.label = transition.id, transition.label
    message.start_state.id, message.start_state.label = STATES[transition.start]
    message.goal_state.id, message.goal_state.label = STATES[transition.goal]
    return message
