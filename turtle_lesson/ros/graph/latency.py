"""How long messages and requests are under way in the simulation's usual network."""

from __future__ import annotations

import zlib

LATENCY = 100_000
"""How long a message is under way, in ns: what a real rclpy needs from publish to callback is 81 to 107 µs. Each
name has its own few µs on top, so that of two messages sent at the same instant the order never depends on chance."""

LATENCY_SPREAD = 20_000


def latency_of(name: str) -> int:
    """The time, in ns, that messages of a topic (or requests of a service) are under way: fixed for each name.

    The topics and services behind an action share one, so that its result does not overtake its feedback.
    """
    return LATENCY + zlib.crc32(name.partition("/_action/")[0].encode()) % LATENCY_SPREAD


def nobody() -> None:
    """What is called when data arrives for somebody who does not wait for it yet."""
