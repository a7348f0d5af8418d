"""Quality of service: what a writer offers, what a reader requests, and whether the two go together.

Facts: https://docs.ros.org/en/humble/Concepts/Intermediate/About-Quality-of-Service-Settings.html (compatibilities); of
several policies that do not go together, the first in the order of Cyclone DDS (ddsi_qosmatch.c) is named.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Quality:
    """The policies that decide about delivery. Spans are in ns, None for endless.

    `depth` is the queue's length, None to keep all; `manual` is liveliness that the program itself asserts.
    """

    depth: int | None = 10
    reliable: bool = True
    latched: bool = False
    deadline: int | None = None
    lifespan: int | None = None
    manual: bool = False
    lease: int | None = None

    def refusal(self, requested: Quality) -> str | None:
        """The policy of this offer that a request cannot accept, by its ROS name, or None."""
        if requested.reliable and not self.reliable:
            return "RELIABILITY"
        if requested.latched and not self.latched:
            return "DURABILITY"
        if _shorter(requested.deadline, self.deadline):
            return "DEADLINE"
        if (requested.manual and not self.manual) or _shorter(requested.lease, self.lease):
            return "LIVELINESS"
        return None


def _shorter(requested: int | None, offered: int | None) -> bool:
    """Whether a span that is requested is shorter than the one that is offered."""
    return requested is not None and (offered is None or requested < offered)
