"""Service introspection (newer than Humble): what is asked and answered is published on `<service>/_service_event`.

Facts: rclpy's service.py and client.py, rcl's service_event_publisher.c, service_msgs/msg/ServiceEventInfo.
"""

from __future__ import annotations

import zlib
from enum import IntEnum
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.graph.service import REQUEST_RECEIVED, REQUEST_SENT, ClientEnd, ServerEnd

if TYPE_CHECKING:
    from .client import Client
    from .clock import Clock
    from .publisher import Publisher
    from .qos import QoSProfile
    from .service import Service

__all__ = ["ServiceIntrospectionState"]


class ServiceIntrospectionState(IntEnum):
    """How much is published."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2


class _EventPublisher:
    """Publishes what happens at one end of a service."""

    def __init__(self, publisher: Publisher, event_type: Any, clock: Clock, with_contents: bool) -> None:
        self.publisher = publisher
        self._event_type, self._clock, self._with_contents = event_type, clock, with_contents

    def __call__(self, kind: int, client: ClientEnd, number: int, message: Any) -> None:
        event = self._event_type()
        event.info.event_type = kind
        event.info.stamp = self._clock.now().to_msg()
        event.info.client_gid = _gid(client)
        event.info.sequence_number = number
        if self._with_contents:
            setattr(event, "request" if kind in (REQUEST_SENT, REQUEST_RECEIVED) else "response", [message])
        self.publisher.publish(event)


def introspect(
    owner: Client | Service, end: ClientEnd | ServerEnd, clock: Clock, profile: QoSProfile, state: int
) -> None:
    """Publish from now on what happens at an end; OFF ends that.

    Raises TypeError or ValueError for arguments that are none.
    """
    from .clock import Clock

    if not isinstance(clock, Clock):
        raise TypeError(f"a clock is expected, got {clock!r}: try node.get_clock()")
    wanted = ServiceIntrospectionState(state)
    forget(end)
    if wanted is ServiceIntrospectionState.OFF:
        return
    node: Any = owner._node
    event_type = owner.srv_type.Event
    publisher = node.create_publisher(event_type, f"{end.name}/_service_event", profile)
    node._ros_publishers.remove(publisher)  # it belongs to the client or service, and goes with it
    end.witness = _EventPublisher(publisher, event_type, clock, wanted is ServiceIntrospectionState.CONTENTS)


def forget(end: ClientEnd | ServerEnd) -> None:
    """Publish no more."""
    witness, end.witness = end.witness, None
    if isinstance(witness, _EventPublisher):
        witness.publisher.destroy()


def _gid(client: ClientEnd) -> list[int]:
    """A client's number in the graph, the same in every run."""
    node = client.node
    tag = zlib.crc32(f"{node.process.pid}/{node.full_name}/{client.name}".encode())
    return [*tag.to_bytes(4, "big"), *node.process.pid.to_bytes(4, "big"), *([0] * 8)]
