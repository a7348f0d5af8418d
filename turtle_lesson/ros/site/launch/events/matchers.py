"""Functions that say which action an event is meant for."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..action import Action


def matches_action(action: Action) -> Callable[[Action], bool]:
    """Matches this very action."""
    return lambda other: other is action
