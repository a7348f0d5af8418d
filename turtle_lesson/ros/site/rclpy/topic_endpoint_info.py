"""What the graph says about one end of a topic."""

from __future__ import annotations

from enum import IntEnum

from .qos import QoSProfile


class TopicEndpointTypeEnum(IntEnum):
    """Which end it is."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


class TopicEndpointInfo:
    """A publisher or subscription of a topic, with its node."""

    def __init__(
        self,
        *,
        node_name: str,
        node_namespace: str,
        topic_type: str,
        endpoint_type: TopicEndpointTypeEnum,
        endpoint_gid: list[int],
        qos_profile: QoSProfile,
    ) -> None:
        self.node_name = node_name
        self.node_namespace = node_namespace
        self.topic_type = topic_type
        self.endpoint_type = endpoint_type
        self.endpoint_gid = endpoint_gid
        self.qos_profile = qos_profile

    def __repr__(self) -> str:
        return (
            f"<TopicEndpointInfo {self.endpoint_type.name} of {self.node_namespace}{self.node_name}, {self.topic_type}>"
        )
