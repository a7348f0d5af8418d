"""Warnings of a node's own that, as in rclpy, are printed while the node is spun."""

from __future__ import annotations

from collections import deque
from typing import Any

from ._entity import GUARD, Entity
from .callback_groups import CallbackGroup


class QoSEvents(Entity):
    """Warnings that are not told yet."""

    _kind = GUARD

    def __init__(self, logger: Any, callback_group: CallbackGroup) -> None:
        super().__init__(logger.warning, callback_group)
        self._texts: deque[str] = deque()

    def add(self, text: str) -> None:
        """Have a warning logged when the node is spun."""
        self._texts.append(text)
        self._signal()

    def _has_work(self) -> bool:
        return bool(self._texts)

    def _take(self) -> tuple[Any, ...]:
        text = self._texts.popleft()
        if self._texts:
            self._signal()
        return (text,)
