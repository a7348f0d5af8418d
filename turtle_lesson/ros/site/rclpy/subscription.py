"""Subscriptions."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from enum import Enum
from types import GenericAlias
from typing import Any

from turtle_lesson.ros.core import EPOCH
from turtle_lesson.ros.distro import MESSAGE_INFO
from turtle_lesson.ros.graph import Reader
from turtle_lesson.ros.world import current_world

from ._borrowed import borrowed
from ._entity import SUBSCRIPTION, Entity
from .callback_groups import CallbackGroup
from .event_handler import EventHandler, SubscriptionEventCallbacks
from .exceptions import RCLError
from .qos import QoSProfile
from .subscription_content_filter_options import ContentFilterOptions

REFUSED = "create_contentfilteredtopic() failed to create contentfilteredtopic"
NOT_SET = "Failed to set cft expression parameters"


class Subscription(Entity):
    """Made by `Node.create_subscription`. A callback with two parameters also gets the message's times (ns)."""

    _kind = SUBSCRIPTION
    __class_getitem__: Any = classmethod(GenericAlias)  # newer releases: Subscription[String] in a hint

    class CallbackType(Enum):
        """What a callback is called with (since Iron)."""

        MessageOnly = 0
        WithMessageInfo = 1

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
        self._filter: ContentFilterOptions | None = None
        self._logger_name = subscription_impl.node.logger_name
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

    @property
    def logger_name(self) -> str:
        """The name of the node's logger."""
        return self._logger_name

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

    @property
    def is_cft_supported(self) -> bool:
        """Whether there are content filters: here there are (with some middlewares there are none)."""
        return True

    @property
    def is_cft_enabled(self) -> bool:
        """Whether a filter chooses among the messages."""
        return self._filter is not None

    def set_content_filter(self, filter_expression: str, expression_parameters: list[str]) -> None:
        """Let in only the messages that an expression is true for; '' lets all in again.

        Raises TypeError, and RCLError for what is no filter for messages of this type.
        """
        from ._content_filter import prepared

        wanted = ContentFilterOptions(filter_expression, expression_parameters)
        refusal = REFUSED if self._filter is None else "failed to set_filter_expression"
        found = prepared(self.msg_type, wanted, f"{NOT_SET}: {refusal}")
        if found[0] is None and self._filter is None:
            raise RCLError(f"{NOT_SET}: current subscriber has no content filter topic")
        self._use_filter(*found)

    def get_content_filter(self) -> ContentFilterOptions:
        """The filter as it was given. Raises RCLError if there is none."""
        if self._filter is None:
            raise RCLError(
                "Failed to get cft expression parameters: this subscriber has not created a ContentFilteredTopic"
            )
        return self._filter

    def _use_filter(self, options: ContentFilterOptions | None, chooses: Callable[[Any], bool] | None) -> None:
        self._filter = options
        self._reader.choose(chooses)

    def destroy(self) -> None:
        """Leave the topic."""
        if not self._destroyed:
            super().destroy()
            for handler in self.event_handlers:
                handler.destroy()
            self._reader.node.process.locals["world"].graph.remove_topic_end(self._reader)


def _wants_info(callback: Callable[..., Any] | None) -> bool:
    try:
        parameters = inspect.signature(callback).parameters.values() if callback is not None else ()
    except (TypeError, ValueError):
        return False
    needed = [each for each in parameters if each.default is each.empty and each.kind in (0, 1)]
    return len(needed) == 2


__getattr__ = borrowed(__name__)
