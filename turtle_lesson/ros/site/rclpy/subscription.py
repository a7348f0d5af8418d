"""Subscriptions."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from turtle_lesson.ros.distro import MESSAGE_INFO
from turtle_lesson.ros.rmw.reader import Reader
from turtle_lesson.ros.runtime.world import current_world
from turtle_lesson.ros.sim.simulation import EPOCH

from ._entity import SUBSCRIPTION, Entity
from .callback_groups import CallbackGroup
from .event_handler import EventHandler, SubscriptionEventCallbacks
from .qos import QoSProfile


class Subscription(Entity):
    """Made by `Node.create_subscription`. A callback with two parameters also gets the message's times (ns)."""

    _kind = SUBSCRIPTION

    def __init__(
        self,
        subscription_impl: Reader,
        msg_type: type,
        topic: str,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        raw: bool,
        event_callbacks: SubscriptionEventCallbacks,
    ) -> None:
        super().__init__(callback, callback_group)
        self._reader = subscription_impl
        self._queue = subscription_impl.queue
        subscription_impl.wake = self._signal
        self.msg_type = msg_type
        self.topic = topic
        self.qos_profile = qos_profile
        self.raw = raw
        if _wants_info(callback):
            current_world().release.note_use(MESSAGE_INFO)
            subscription_impl.keep_times()
        self.event_handlers: list[EventHandler] = event_callbacks.create_event_handlers(callback_group, self, topic)

    def __repr__(self) -> str:
        return f"<Subscription of {self.topic}>"

    @property
    def topic_name(self) -> str:
        """The topic's full name."""
        return self._reader.topic.name

    def _end(self) -> Reader:
        return self._reader

    def get_publisher_count(self) -> int:
        """How many publishers this subscription hears."""
        return self._reader.connections()

    def _has_work(self) -> bool:
        return bool(self._queue)

    def _take(self) -> tuple[Any, ...]:
        message = self._queue.popleft()
        if self._queue:
            self._signal()  # one message a cycle: the rest waits for the next one
        if self.raw:
            from .serialization import serialize_message

            message = serialize_message(message)
        times = self._reader.times
        if times is None:
            return (message,)
        sent, received = times.popleft()
        return (message, {"source_timestamp": EPOCH + sent, "received_timestamp": EPOCH + received})

    def destroy(self) -> None:
        """Leave the topic."""
        if not self._destroyed:
            super().destroy()
            for handler in self.event_handlers:
                handler.destroy()
            self._reader.node.process.world.graph.remove_topic_end(self._reader)


def _wants_info(callback: Callable[..., Any] | None) -> bool:
    try:
        parameters = inspect.signature(callback).parameters.values() if callback is not None else ()
    except (TypeError, ValueError):
        return False
    needed = [each for each in parameters if each.default is each.empty and each.kind in (0, 1)]
    return len(needed) == 2
