"""Quality of service: what a writer offers, what a reader requests, and whether the two go together.

Facts: https://docs.ros.org/en/humble/Concepts/Intermediate/About-Quality-of-Service-Settings.html (compatibilities).
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Quality:
    """The policies that decide about delivery; `depth` is the queue's length, None to keep all."""

    depth: int | None = 10
    reliable: bool = True
    latched: bool = False

    def refusal(self, requested: Quality) -> str | None:
        """The policy of this offer that a request cannot accept, by its ROS name, or None."""
        if requested.reliable and not self.reliable:
            return "RELIABILITY"
        if requested.latched and not self.latched:
            return "DURABILITY"
        return None
