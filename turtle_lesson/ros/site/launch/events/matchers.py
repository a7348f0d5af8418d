"""Functions that say which action an event is meant for."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..action import Action
    from ..actions import ExecuteLocal


def matches_action(action: Action) -> Callable[[Action], bool]:
    """Matches this very action."""
    return lambda other: other is action


def matches_pid(pid: int) -> Callable[[ExecuteLocal], bool]:
    """Matches the action whose process has this number."""
    return lambda action: (action.process_details or {}).get("pid") == pid


def matches_name(name: str) -> Callable[[ExecuteLocal], bool]:
    """Matches the action whose process has this name, such as `navigator-1`."""
    return lambda action: (action.process_details or {}).get("name") == name


def matches_executable(executable: str) -> Callable[[ExecuteLocal], bool]:
    """Matches the actions that run this program."""

    def matches(action: ExecuteLocal) -> bool:
        command = (action.process_details or {}).get("cmd") or [""]
        return str(command[0]).rsplit("/", 1)[-1] == executable

    return matches
