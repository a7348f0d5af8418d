"""The states of a managed node, and the transitions between them: rcl's default state machine."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from typing import NamedTuple

from ..exceptions import RCLError
from ..impl.rcutils_logger import RcutilsLogger


class State(NamedTuple):
    """A state: its number and its label."""

    id: int
    label: str


class Transition(NamedTuple):
    """A transition: its number, its label, and the states that it leads from and to."""

    id: int
    label: str
    start: State
    goal: State


class TransitionCallbackReturnType(Enum):
    """What a transition's callback returns: `rclpy.lifecycle.TransitionCallbackReturn`."""

    SUCCESS = 97
    FAILURE = 98
    ERROR = 99

    def __int__(self) -> int:
        return self.value

    def to_label(self) -> str:
        """The label of the transition that follows."""
        return f"transition_{self.name.lower()}"


STATES = {
    label: State(number, label)
    for number, label in (
        (0, "unknown"),
        (1, "unconfigured"),
        (2, "inactive"),
        (3, "active"),
        (4, "finalized"),
        (10, "configuring"),
        (11, "cleaningup"),
        (12, "shuttingdown"),
        (13, "activating"),
        (14, "deactivating"),
        (15, "errorprocessing"),
    )
}


def _transition(number: int, label: str, start: str, goal: str) -> Transition:
    return Transition(number, label, STATES[start], STATES[goal])


def _outcomes(number: int, state: str, success: str, failure: str, error: str = "errorprocessing") -> list[Transition]:
    """How a state in which a callback runs is left."""
    goals = {"success": success, "failure": failure, "error": error}
    return [_transition(number + i, f"transition_{how}", state, goal) for i, (how, goal) in enumerate(goals.items())]


TRANSITIONS = [
    _transition(1, "configure", "unconfigured", "configuring"),
    *_outcomes(10, "configuring", "inactive", "unconfigured"),
    _transition(2, "cleanup", "inactive", "cleaningup"),
    *_outcomes(20, "cleaningup", "unconfigured", "inactive"),
    _transition(3, "activate", "inactive", "activating"),
    *_outcomes(30, "activating", "active", "inactive"),
    _transition(4, "deactivate", "active", "deactivating"),
    *_outcomes(40, "deactivating", "inactive", "active"),
    _transition(5, "shutdown", "unconfigured", "shuttingdown"),
    _transition(6, "shutdown", "inactive", "shuttingdown"),
    _transition(7, "shutdown", "active", "shuttingdown"),
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
        return [each for each in TRANSITIONS if each.start == self.current_state]

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
        self.current_state = transition.goal
        self._notify(transition.start, transition.goal)
