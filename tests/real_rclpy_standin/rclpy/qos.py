"""Quality of service: what the lab asks for."""

from __future__ import annotations

from enum import IntEnum


class ReliabilityPolicy(IntEnum):
    RELIABLE = 1
    BEST_EFFORT = 2


class DurabilityPolicy(IntEnum):
    TRANSIENT_LOCAL = 1
    VOLATILE = 2


class QoSProfile:
    def __init__(
        self,
        *,
        depth: int,
        reliability: ReliabilityPolicy = ReliabilityPolicy.RELIABLE,
        durability: DurabilityPolicy = DurabilityPolicy.VOLATILE,
    ) -> None:
        self.depth, self.reliability, self.durability = depth, reliability, durability

    def fits(self, wanted: QoSProfile) -> bool:
        """Not in the real one: whether a publisher of this profile serves a subscription of that one."""
        return self.reliability <= wanted.reliability and self.durability <= wanted.durability


def profile(given: QoSProfile | int) -> QoSProfile:
    return given if isinstance(given, QoSProfile) else QoSProfile(depth=given)
