"""What the graph says about one end of a topic."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum

from .qos import HistoryPolicy, QoSProfile, qos_profile_unknown


class TopicEndpointTypeEnum(IntEnum):
    """Which end it is."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


@dataclass(kw_only=True)
class TopicEndpointInfo:
    """A publisher or subscription of a topic, with its node. As text it is what `ros2 topic info -v` shows of it.

    That is what Humble shows: without the hash of the type, which is of newer releases.
    """

    node_name: str = ""
    node_namespace: str = ""
    topic_type: str = ""
    endpoint_type: TopicEndpointTypeEnum = TopicEndpointTypeEnum.INVALID
    endpoint_gid: list[int] = field(default_factory=list)
    qos_profile: QoSProfile = field(default_factory=lambda: qos_profile_unknown)

    def __str__(self) -> str:
        profile = self.qos_profile
        history = profile.history.name
        if profile.history == HistoryPolicy.KEEP_LAST:
            history = f"{history} ({profile.depth})"
        return "\n".join(
            [
                f"Node name: {self.node_name}",
                f"Node namespace: {self.node_namespace}",
                f"Topic type: {self.topic_type}",
                f"Endpoint type: {self.endpoint_type.name}",
                f"GID: {'.'.join(f'{byte:02x}' for byte in self.endpoint_gid)}",
                "QoS profile:",
                f"  Reliability: {profile.reliability.name}",
                f"  History (Depth): {history}",
                f"  Durability: {profile.durability.name}",
                f"  Lifespan: {profile.lifespan}",
                f"  Deadline: {profile.deadline}",
                f"  Liveliness: {profile.liveliness.name}",
                f"  Liveliness lease duration: {profile.liveliness_lease_duration}",
            ]
        )
