"""What the real one leaves to DDS: who is there, who has been discovered, and who gets what."""

from __future__ import annotations

import threading
import time
from typing import Any

DISCOVERY = 0.1
"""Seconds until nodes of other contexts see something new."""

lock = threading.RLock()
contexts: list[Any] = []
nodes: list[Any] = []
ends: list[Any] = []


class End:
    """A publisher ("pub"), a subscription ("sub"), a service ("srv") or a client ("cli")."""

    def __init__(self, kind: str, node: Any, name: str, type_name: str, qos: Any = None) -> None:
        self._kind, self._node, self._full_name, self._type_name = kind, node, name, type_name
        self._qos, self._born = qos, time.monotonic()
        with lock:
            ends.append(self)

    def _leave(self) -> None:
        with lock:
            if self in ends:
                ends.remove(self)


def sees(node: Any, other: Any) -> bool:
    """Whether a node has discovered an end, or a node."""
    home = other if hasattr(other, "_gid") else other._node
    return home.context is node.context or time.monotonic() - other._born >= DISCOVERY


def found(node: Any, *kinds: str) -> list[Any]:
    """The ends that a node sees."""
    with lock:
        return [end for end in ends if end._kind in kinds and sees(node, end)]


def matched(end: Any, kind: str) -> list[Any]:
    """The ends at the other side of one: both have discovered each other, and have the same type."""
    return [
        other
        for other in found(end._node, kind)
        if other._full_name == end._full_name and other._type_name == end._type_name and sees(other._node, end)
    ]
