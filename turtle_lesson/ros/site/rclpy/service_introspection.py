"""Service introspection (newer than Humble): publishing what is asked and answered. It is not built here."""

from __future__ import annotations

from enum import IntEnum

__all__ = ["ServiceIntrospectionState"]


class ServiceIntrospectionState(IntEnum):
    """How much is published."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2


def refuse(introspection_state: ServiceIntrospectionState) -> None:
    """Raise NotImplementedError for anything but OFF."""
    if ServiceIntrospectionState(introspection_state) != ServiceIntrospectionState.OFF:
        raise NotImplementedError(
            "service introspection is not built in this classroom: nothing is published on …/_service_event. "
            "`ros2 service call` shows requests and answers, and so may a log line in the service's callback."
        )
