"""Events: what happens while a launch runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .._missing import explain_missing
from ..event import Event
from . import process
from .include_launch_description import IncludeLaunchDescription
from .matchers import matches_action

if TYPE_CHECKING:
    from ..action import Action
    from ..actions import TimerAction

__all__ = ["ExecutionComplete", "IncludeLaunchDescription", "Shutdown", "TimerEvent", "matches_action", "process"]


class Shutdown(Event):
    """The whole launch is to end."""

    name = "launch.events.Shutdown"

    def __init__(self, *, reason: str = "reason not given", due_to_sigint: bool = False, **kwargs: object) -> None:
        self.reason = reason
        self.due_to_sigint = due_to_sigint


class TimerEvent(Event):
    """A TimerAction's time is over."""

    name = "launch.events.TimerEvent"

    def __init__(self, *, timer_action: TimerAction) -> None:
        self.timer_action = timer_action


class ExecutionComplete(Event):
    """An action is done."""

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: Action) -> None:
        self.action = action


__getattr__ = explain_missing(__name__, {})
