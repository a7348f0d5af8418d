"""Warnings about publishers and subscriptions that cannot go together. As in rclpy, whoever spins the node hears them."""

from __future__ import annotations

from collections import deque
from typing import Any

from ._entity import GUARD, Entity
from .callback_groups import CallbackGroup
from .duration import Duration, Infinite
from .qos import QoSProfile

UNENFORCED = ("lifespan", "deadline", "liveliness_lease_duration")
NO_LIMIT = (Duration(), Infinite)
SIM_TIME = (
    "The parameter use_sim_time is true, but this classroom has only one clock, which is simulated already: "
    "messages on /clock are not followed."
)


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


def unenforced_text(what: str, topic: str, profile: QoSProfile) -> str:
    """What is to be said about policies that a publisher or subscription asks for, and that do nothing here; or ''."""
    asked = {name: getattr(profile, name) for name in UNENFORCED}
    policies = [f"{name} of {each.nanoseconds / 1e9:g} s" for name, each in asked.items() if each not in NO_LIMIT]
    if not policies:
        return ""
    return (
        f"The {what} of '{topic}' asks for a {' and a '.join(policies)}. This classroom does not enforce that yet: "
        "messages neither expire nor are missed, and nobody is refused for it. A real robot does it."
    )
