"""Callbacks for what happens to publishers and subscriptions: deadlines missed, partners that do not fit, messages lost.

rclpy's event_handler.py of today, which in Humble is qos_event.py; `incompatible_type` and `matched` came with Jazzy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, ClassVar, NamedTuple, cast

from turtle_lesson.ros.rmw.endpoint import End

from ._entity import WAITABLE, Entity
from ._rclpy_pybind11 import UnsupportedEventTypeError
from .callback_groups import CallbackGroup
from .clock_type import CEnum
from .logging import get_logger
from .qos import QoSPolicyKind, qos_policy_name_from_kind

rmw_qos_policy_kind_t = cast("Any", CEnum)(
    "rmw_qos_policy_kind_t", {f"RMW_QOS_POLICY_{kind.name}": kind for kind in QoSPolicyKind}
)
"""Which policy did not fit. Its members equal those of QoSPolicyKind, but print as those of rclpy's C++ half."""


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


class _Count(NamedTuple):
    total_count: int = 0
    total_count_change: int = 0


class QoSRequestedDeadlineMissedInfo(_Count):
    """How often a subscription waited longer than its deadline, in all and since it was last told."""


class QoSOfferedDeadlineMissedInfo(_Count):
    """How often a publisher took longer than its deadline, in all and since it was last told."""


class QoSLivelinessLostInfo(_Count):
    """How often a publisher's lease was over, in all and since it was last told."""


class QoSMessageLostInfo(_Count):
    """How many messages never reached a subscription, in all and since it was last told."""


class IncompatibleTypeInfo(_Count):
    """How many partners have another type on this topic, in all and since it was last told."""


class QoSLivelinessChangedInfo(NamedTuple):
    """How many of a subscription's publishers are alive and how many are not, and how that has changed."""

    alive_count: int = 0
    not_alive_count: int = 0
    alive_count_change: int = 0
    not_alive_count_change: int = 0


class QoSRequestedIncompatibleQoSInfo(NamedTuple):
    """With how many partners the quality of service does not go together, and which policy it was the last time."""

    total_count: int = 0
    total_count_change: int = 0
    last_policy_kind: int = QoSPolicyKind.INVALID


class QoSSubscriptionMatchedInfo(NamedTuple):
    """With how many partners there has been a connection, with how many there is one, and how that has changed."""

    total_count: int = 0
    current_count: int = 0
    total_count_change: int = 0
    current_count_change: int = 0


QoSOfferedIncompatibleQoSInfo = QoSRequestedIncompatibleQoSInfo
QoSPublisherMatchedInfo = QoSSubscriptionMatchedInfo

_PUBLISHER = QoSPublisherEventType
_SUBSCRIPTION = QoSSubscriptionEventType
_Events = dict[IntEnum, tuple[str, Any]]
"""Per type of event, in rclpy's order: what its callback and its status in the graph are called, and what it is told as."""

PUBLISHER_EVENTS: _Events = {
    _PUBLISHER.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED: ("deadline", QoSOfferedDeadlineMissedInfo),
    _PUBLISHER.RCL_PUBLISHER_LIVELINESS_LOST: ("liveliness", QoSLivelinessLostInfo),
    _PUBLISHER.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS: ("incompatible_qos", QoSOfferedIncompatibleQoSInfo),
    _PUBLISHER.RCL_PUBLISHER_INCOMPATIBLE_TYPE: ("incompatible_type", IncompatibleTypeInfo),
    _PUBLISHER.RCL_PUBLISHER_MATCHED: ("matched", QoSPublisherMatchedInfo),
}
SUBSCRIPTION_EVENTS: _Events = {
    _SUBSCRIPTION.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED: ("deadline", QoSRequestedDeadlineMissedInfo),
    _SUBSCRIPTION.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS: ("incompatible_qos", QoSRequestedIncompatibleQoSInfo),
    _SUBSCRIPTION.RCL_SUBSCRIPTION_LIVELINESS_CHANGED: ("liveliness", QoSLivelinessChangedInfo),
    _SUBSCRIPTION.RCL_SUBSCRIPTION_MESSAGE_LOST: ("message_lost", QoSMessageLostInfo),
    _SUBSCRIPTION.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE: ("incompatible_type", IncompatibleTypeInfo),
    _SUBSCRIPTION.RCL_SUBSCRIPTION_MATCHED: ("matched", QoSSubscriptionMatchedInfo),
}


class EventHandler(Entity):
    """Waits for events of one type of a publisher or subscription, `parent_impl`."""

    _kind = WAITABLE

    def __init__(
        self, *, callback_group: CallbackGroup, callback: Callable[[Any], Any], event_type: IntEnum, parent_impl: Any
    ) -> None:
        super().__init__(callback, callback_group)
        self.event_type = event_type
        publishes = hasattr(parent_impl, "publish")
        expected = QoSPublisherEventType if publishes else QoSSubscriptionEventType
        if not isinstance(event_type, expected):
            raise UnsupportedEventTypeError(f"one of {expected.__name__} is expected, got {event_type!r}")
        kind, self._info = (PUBLISHER_EVENTS if publishes else SUBSCRIPTION_EVENTS)[event_type]
        self._end: End = parent_impl._end()
        self._tally = self._end.listen(kind)
        self._tally.wake = self._signal

    def __repr__(self) -> str:
        return f"<EventHandler of {self.event_type.name}>"

    def _has_work(self) -> bool:
        return self._tally.news

    def _take(self) -> tuple[Any, ...]:
        info = self._info(*self._tally.take())
        if isinstance(info, QoSRequestedIncompatibleQoSInfo):
            info = info._replace(last_policy_kind=rmw_qos_policy_kind_t(QoSPolicyKind[self._end.last_policy]))
        return (info,)


QoSEventHandler = EventHandler


class _EventCallbacks:
    """Base class: `_events` says which attribute is called for which type of event."""

    _events: ClassVar[_Events]
    _mismatch: ClassVar[str]
    use_default_callbacks: bool

    def create_event_handlers(self, callback_group: CallbackGroup, entity: Any, topic_name: str) -> list[EventHandler]:
        """Handlers for all callbacks that were given, and for those that stand in for one that was not."""

        def warn(event: Any) -> None:
            policy = qos_policy_name_from_kind(event.last_policy_kind)
            get_logger(entity.logger_name).warning(self._mismatch.format(topic=topic_name, policy=policy))

        stand_ins = {"incompatible_qos": warn} if self.use_default_callbacks else {}
        chosen = [(kind, getattr(self, name) or stand_ins.get(name)) for kind, (name, _) in self._events.items()]
        return [
            EventHandler(callback_group=callback_group, callback=callback, event_type=kind, parent_impl=entity)
            for kind, callback in chosen
            if callback
        ]


@dataclass(kw_only=True, eq=False)
class SubscriptionEventCallbacks(_EventCallbacks):
    """What to call when something happens to a subscription. Without `incompatible_qos` a warning is logged for it."""

    _events: ClassVar[_Events] = SUBSCRIPTION_EVENTS
    _mismatch: ClassVar[str] = (
        "New publisher discovered on topic '{topic}', offering incompatible QoS. No messages will be received from it. "
        "Last incompatible policy: {policy}"
    )

    deadline: Callable[[QoSRequestedDeadlineMissedInfo], Any] | None = None
    incompatible_qos: Callable[[QoSRequestedIncompatibleQoSInfo], Any] | None = None
    liveliness: Callable[[QoSLivelinessChangedInfo], Any] | None = None
    message_lost: Callable[[QoSMessageLostInfo], Any] | None = None
    incompatible_type: Callable[[IncompatibleTypeInfo], Any] | None = None
    matched: Callable[[QoSSubscriptionMatchedInfo], Any] | None = None
    use_default_callbacks: bool = True


@dataclass(kw_only=True, eq=False)
class PublisherEventCallbacks(_EventCallbacks):
    """What to call when something happens to a publisher. Without `incompatible_qos` a warning is logged for it."""

    _events: ClassVar[_Events] = PUBLISHER_EVENTS
    _mismatch: ClassVar[str] = (
        "New subscription discovered on topic '{topic}', requesting incompatible QoS. No messages will be sent to it. "
        "Last incompatible policy: {policy}"
    )

    deadline: Callable[[QoSOfferedDeadlineMissedInfo], Any] | None = None
    liveliness: Callable[[QoSLivelinessLostInfo], Any] | None = None
    incompatible_qos: Callable[[QoSOfferedIncompatibleQoSInfo], Any] | None = None
    incompatible_type: Callable[[IncompatibleTypeInfo], Any] | None = None
    matched: Callable[[QoSPublisherMatchedInfo], Any] | None = None
    use_default_callbacks: bool = True
