"""Warnings about publishers and subscriptions that cannot go together. As in rclpy, whoever spins the node hears them."""

from __future__ import annotations

from collections import deque
from typing import Any

from ._entity import GUARD, Entity
from .callback_groups import CallbackGroup


class QoSEvents(Entity):
    """What has happened to the qualities of service of a node's publishers and subscriptions, and is not told yet."""

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


def mismatch_text(topic: str, policy: str, *, publishes: bool) -> str:
    """What a publisher, or else a subscription, says about somebody whose messages cannot go its way."""
    who, verb, fate = (
        ("subscription", "requesting", "sent to") if publishes else ("publisher", "offering", "received from")
    )
    return (
        f"New {who} discovered on topic '{topic}', {verb} incompatible QoS. "
        f"No messages will be {fate} it. Last incompatible policy: {policy}"
    )
