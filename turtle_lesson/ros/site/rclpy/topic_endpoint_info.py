"""What the graph says about one end of a topic."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

from .qos import HistoryPolicy, QoSProfile, qos_profile_unknown


class TopicEndpointTypeEnum(IntEnum):
    """Which end it is."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


_KINDS: dict[str, type] = {
    "node_name": str,
    "node_namespace": str,
    "topic_type": str,
    "endpoint_type": TopicEndpointTypeEnum,
    "endpoint_gid": list,
    "qos_profile": QoSProfile,
}


class TopicEndpointInfo:
    """A publisher or subscription of a topic, with its node. As text it is what `ros2 topic info -v` shows of it.

    That is what Humble shows: without the hash of the type, which is of newer releases.
    """

    node_name: str
    node_namespace: str
    topic_type: str
    endpoint_type: TopicEndpointTypeEnum
    endpoint_gid: list[int]
    qos_profile: QoSProfile

    def __init__(self, **fields: Any) -> None:
        unknown = ", ".join(sorted(set(fields) - set(_KINDS)))
        assert not unknown, f"Invalid arguments passed to constructor: {unknown}; there are {', '.join(_KINDS)}"
        for name, default in (
            ("node_name", ""),
            ("node_namespace", ""),
            ("topic_type", ""),
            ("endpoint_type", TopicEndpointTypeEnum.INVALID),
            ("endpoint_gid", []),
            ("qos_profile", qos_profile_unknown),
        ):
            setattr(self, name, fields.get(name, default))

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"a TopicEndpointInfo has no {name!r}; it has {', '.join(_KINDS)}")

    def __setattr__(self, name: str, value: Any) -> None:
        kind = _KINDS.get(name)
        if kind is None:
            raise AttributeError(f"a TopicEndpointInfo has no {name!r}; it has {', '.join(_KINDS)}")
        if kind is QoSProfile and isinstance(value, dict):
            value = QoSProfile(**value)
        if kind is TopicEndpointTypeEnum and isinstance(value, int):
            value = TopicEndpointTypeEnum(value)
        if kind is list:
            value = list(value)
        assert isinstance(value, kind), f"{name} must be a {kind.__name__}, got {value!r}"
        object.__setattr__(self, name, value)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TopicEndpointInfo) and all(
            getattr(self, name) == getattr(other, name) for name in _KINDS
        )

    __hash__ = None  # type: ignore[assignment]

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

    def __repr__(self) -> str:
        full_name = f"{self.node_namespace.rstrip('/')}/{self.node_name}"
        return f"<TopicEndpointInfo {self.endpoint_type.name} of {full_name}, {self.topic_type}>"
