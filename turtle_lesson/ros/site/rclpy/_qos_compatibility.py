"""Whether a publisher and a subscription of two profiles can talk to each other, before there are any.

Facts: rmw_dds_common's qos.cpp, where the rules and the sentences come from.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import Enum
from typing import TYPE_CHECKING

from ._qos_policies import DurabilityPolicy, LivelinessPolicy, QoSPolicyEnum, ReliabilityPolicy

if TYPE_CHECKING:
    from .qos import QoSProfile


class QoSCompatibility(Enum):
    """The answer. WARNING: it depends on what the middleware takes for `system default`."""

    OK = 0
    WARNING = 1
    ERROR = 2


def qos_check_compatible(publisher_qos: QoSProfile, subscription_qos: QoSProfile) -> tuple[QoSCompatibility, str]:
    """Whether the two can talk to each other, and the reasons, one after the other, if they cannot or perhaps not."""
    errors = list(_errors(publisher_qos, subscription_qos))
    if errors:
        return QoSCompatibility.ERROR, "".join(f"ERROR: {error};" for error in errors)
    doubts = list(_doubts(publisher_qos, subscription_qos))
    if doubts:
        return QoSCompatibility.WARNING, "".join(f"WARNING: {doubt};" for doubt in doubts)
    return QoSCompatibility.OK, ""


def _errors(offered: QoSProfile, requested: QoSProfile) -> Iterator[str]:
    """What certainly does not go together."""
    wants = requested.reliability, requested.durability, requested.liveliness
    if (offered.reliability, wants[0]) == (ReliabilityPolicy.BEST_EFFORT, ReliabilityPolicy.RELIABLE):
        yield "Best effort publisher and reliable subscription"
    if (offered.durability, wants[1]) == (DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL):
        yield "Volatile publisher and transient local subscription"
    limits = offered.deadline.nanoseconds, requested.deadline.nanoseconds
    if limits[1] and not limits[0]:
        yield "Subscription has a deadline, but publisher does not"
    if limits[1] and limits[1] < limits[0]:
        yield "Subscription deadline is less than publisher deadline"
    if (offered.liveliness, wants[2]) == (LivelinessPolicy.AUTOMATIC, LivelinessPolicy.MANUAL_BY_TOPIC):
        yield "Publisher's liveliness is automatic and subscription's is manual by topic"
    leases = offered.liveliness_lease_duration.nanoseconds, requested.liveliness_lease_duration.nanoseconds
    if leases[1] and not leases[0]:
        yield "Subscription has a liveliness lease duration, but publisher does not"
    if leases[1] and leases[1] < leases[0]:
        yield "Subscription liveliness lease duration is less than publisher"


def _doubts(offered: QoSProfile, requested: QoSProfile) -> Iterator[str]:
    """What may not go together, because somebody has left it open."""
    publisher, subscription = _word(offered.reliability), _word(requested.reliability)
    if _open(offered.reliability) and _open(requested.reliability):
        yield f"Publisher reliability is {publisher} and subscription reliability is {subscription}"
    elif _open(offered.reliability) and requested.reliability == ReliabilityPolicy.RELIABLE:
        yield f"Reliable subscription, but publisher is {publisher}"
    elif offered.reliability == ReliabilityPolicy.BEST_EFFORT and _open(requested.reliability):
        yield f"Best effort publisher, but subscription is {subscription}"

    publisher, subscription = _word(offered.durability), _word(requested.durability)
    if _open(offered.durability) and _open(requested.durability):
        yield f"Publisher durabilty is {publisher} and subscription durability is {subscription}"
    elif _open(offered.durability) and requested.durability == DurabilityPolicy.TRANSIENT_LOCAL:
        yield f"Transient local subscription, but publisher is {publisher}"
    elif offered.durability == DurabilityPolicy.VOLATILE and _open(requested.durability):
        yield f"Volatile publisher, but subscription is {subscription}"

    publisher, subscription = _word(offered.liveliness), _word(requested.liveliness)
    if _open(offered.liveliness) and _open(requested.liveliness):
        yield f"Publisher liveliness is {publisher} and subscription liveliness is {subscription}"
    elif _open(offered.liveliness) and requested.liveliness == LivelinessPolicy.MANUAL_BY_TOPIC:
        yield f"Subscription's liveliness is manual by topic, but publisher's is {publisher}"
    elif offered.liveliness == LivelinessPolicy.AUTOMATIC and _open(requested.liveliness):
        yield f"Publisher's liveliness is automatic, but subscription's is {subscription}"


def _open(policy: QoSPolicyEnum) -> bool:
    return policy.name in {"SYSTEM_DEFAULT", "UNKNOWN"}


def _word(policy: QoSPolicyEnum) -> str:
    return policy.name.lower()
