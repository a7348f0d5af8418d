"""What may happen to a publisher or subscription, and what its callback is told (rcl's event.h, rmw's events_statuses)."""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple

from turtle_lesson.ros.graph import tally

from ._qos_policies import QoSPolicyKind
from .clock_type import CEnum


class rmw_qos_policy_kind_t(CEnum):
    """Which policy did not fit. Its members equal those of QoSPolicyKind."""

    RMW_QOS_POLICY_INVALID = QoSPolicyKind.INVALID
    RMW_QOS_POLICY_DURABILITY = QoSPolicyKind.DURABILITY
    RMW_QOS_POLICY_DEADLINE = QoSPolicyKind.DEADLINE
    RMW_QOS_POLICY_LIVELINESS = QoSPolicyKind.LIVELINESS
    RMW_QOS_POLICY_RELIABILITY = QoSPolicyKind.RELIABILITY
    RMW_QOS_POLICY_HISTORY = QoSPolicyKind.HISTORY
    RMW_QOS_POLICY_LIFESPAN = QoSPolicyKind.LIFESPAN


class QoSPublisherEventType(IntEnum):
    """What may happen to a publisher (rcl's event.h)."""

    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class QoSSubscriptionEventType(IntEnum):
    """What may happen to a subscription (rcl's event.h)."""

    RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED = 0
    RCL_SUBSCRIPTION_LIVELINESS_CHANGED = 1
    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS = 2
    RCL_SUBSCRIPTION_MESSAGE_LOST = 3
    RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE = 4
    RCL_SUBSCRIPTION_MATCHED = 5


class QoSRequestedDeadlineMissedInfo(NamedTuple):
    """How often a subscription waited longer than its deadline, in all and since it was last told."""

    total_count: int = 0
    total_count_change: int = 0


class QoSOfferedDeadlineMissedInfo(NamedTuple):
    """How often a publisher took longer than its deadline, in all and since it was last told."""

    total_count: int = 0
    total_count_change: int = 0


class QoSLivelinessLostInfo(NamedTuple):
    """How often a publisher's lease was over, in all and since it was last told."""

    total_count: int = 0
    total_count_change: int = 0


class QoSLivelinessChangedInfo(NamedTuple):
    """How many of a subscription's publishers are alive and how many are not, and how that has changed."""

    alive_count: int = 0
    not_alive_count: int = 0
    alive_count_change: int = 0
    not_alive_count_change: int = 0


class QoSMessageLostInfo(NamedTuple):
    """How many messages never reached a subscription, in all and since it was last told."""

    total_count: int = 0
    total_count_change: int = 0


class QoSRequestedIncompatibleQoSInfo(NamedTuple):
    """With how many partners the quality of service does not go together, and which policy it was the last time."""

    total_count: int = 0
    total_count_change: int = 0
    last_policy_kind: int = rmw_qos_policy_kind_t.RMW_QOS_POLICY_INVALID


class IncompatibleTypeInfo(NamedTuple):
    """How many partners have another type on this topic, in all and since it was last told."""

    total_count: int = 0
    total_count_change: int = 0


class QoSSubscriptionMatchedInfo(NamedTuple):
    """With how many partners there has been a connection, with how many there is one, and how that has changed."""

    total_count: int = 0
    total_count_change: int = 0
    current_count: int = 0
    current_count_change: int = 0


QoSOfferedIncompatibleQoSInfo = QoSRequestedIncompatibleQoSInfo
QoSPublisherMatchedInfo = QoSSubscriptionMatchedInfo

PUBLISHER_EVENTS: dict[int, tuple[str, Any]] = {
    QoSPublisherEventType.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED: (tally.DEADLINE, QoSOfferedDeadlineMissedInfo),
    QoSPublisherEventType.RCL_PUBLISHER_LIVELINESS_LOST: (tally.LIVELINESS, QoSLivelinessLostInfo),
    QoSPublisherEventType.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS: (
        tally.INCOMPATIBLE_QOS,
        QoSOfferedIncompatibleQoSInfo,
    ),
    QoSPublisherEventType.RCL_PUBLISHER_INCOMPATIBLE_TYPE: (tally.INCOMPATIBLE_TYPE, IncompatibleTypeInfo),
    QoSPublisherEventType.RCL_PUBLISHER_MATCHED: (tally.MATCHED, QoSPublisherMatchedInfo),
}
"""What the graph counts for each type of event, and what it is told as."""

SUBSCRIPTION_EVENTS: dict[int, tuple[str, Any]] = {
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED: (
        tally.DEADLINE,
        QoSRequestedDeadlineMissedInfo,
    ),
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_LIVELINESS_CHANGED: (tally.LIVELINESS, QoSLivelinessChangedInfo),
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS: (
        tally.INCOMPATIBLE_QOS,
        QoSRequestedIncompatibleQoSInfo,
    ),
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST: (tally.MESSAGE_LOST, QoSMessageLostInfo),
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE: (tally.INCOMPATIBLE_TYPE, IncompatibleTypeInfo),
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_MATCHED: (tally.MATCHED, QoSSubscriptionMatchedInfo),
}
