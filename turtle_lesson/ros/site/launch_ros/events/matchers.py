"""Functions that say which node an event is meant for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Matches the action of the node with this full name; a name without a slash before it gets one."""
    wanted = node_name if node_name.startswith("/") else f"/{node_name}"

    def matches(action: Any) -> bool:
        from ..actions import Node

        return isinstance(action, Node) and action.node_name == wanted

    return matches
