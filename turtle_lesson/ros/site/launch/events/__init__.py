"""Events: what happens while a launch runs."""

from __future__ import annotations

from collections.abc import Callable

from .._context import Event
from .._entities import Action, LaunchDescription

__all__ = ["ExecutionComplete", "IncludeLaunchDescription", "Shutdown", "matches_action"]


class Shutdown(Event):
    """The whole launch is to end."""

    def __init__(self, *, reason: str = "reason not given", due_to_sigint: bool = False, **kwargs: object) -> None:
        self.reason = reason
        self.due_to_sigint = due_to_sigint


class ExecutionComplete(Event):
    """An action is done."""

    def __init__(self, *, action: Action) -> None:
        self.action = action


class IncludeLaunchDescription(Event):
    """A description is to be taken in."""

    def __init__(self, launch_description: LaunchDescription) -> None:
        self.launch_description = launch_description


def matches_action(action: Action) -> Callable[[Action], bool]:
    """Matches this very action."""
    return lambda other: other is action
