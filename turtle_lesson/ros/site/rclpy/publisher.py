"""Publishers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from turtle_lesson.ros.idl import checks
from turtle_lesson.ros.rmw.writer import Writer
from turtle_lesson.ros.sim.simulation import NANOSECONDS
from turtle_lesson.ros.stdlib.deadlock import looked_in_vain

from ._blocking import wait_until
from ._entity import Destroyable
from ._hints import no_message
from .callback_groups import CallbackGroup
from .duration import Duration
from .event_handler import EventHandler, PublisherEventCallbacks
from .qos import QoSProfile

FOR_EVER = Duration(seconds=-1)
LOOK_AGAIN = 1_000_000
"""How often, in ns, `wait_for_all_acked` looks."""


class Publisher(Destroyable):
    """Made by `Node.create_publisher`."""

    def __init__(
        self,
        publisher_impl: Writer,
        msg_type: type,
        topic: str,
        qos_profile: QoSProfile,
        event_callbacks: PublisherEventCallbacks,
        callback_group: CallbackGroup,
    ) -> None:
        self._writer = publisher_impl
        self._write: Callable[[Any], object] = publisher_impl.write
        if not checks.when_assigned:
            self._write = lambda message: publisher_impl.write(checks.sendable(message))
        self._topic_name = publisher_impl.topic.name
        self.msg_type = msg_type
        self.topic = topic
        self.qos_profile = qos_profile
        self.callback_group = callback_group
        self.event_handlers: list[EventHandler] = event_callbacks.create_event_handlers(callback_group, self, topic)

    def __repr__(self) -> str:
        return f"<Publisher of {self.topic}>"

    @property
    def topic_name(self) -> str:
        """The topic's full name."""
        self._check_alive()
        return self._topic_name

    def _end(self, doing: str = "") -> Writer:
        self._check_alive(doing)
        return self._writer

    def publish(self, msg: Any) -> None:
        """Send a message to all matched subscriptions. It is copied: changing `msg` later changes nothing sent.

        Raises TypeError for anything but a message of the publisher's type (or its CDR bytes).
        """
        if msg.__class__ is not self.msg_type and not isinstance(msg, self.msg_type):
            if not isinstance(msg, bytes):
                raise no_message(msg, self.msg_type)
            from turtle_lesson.ros.idl import cdr

            msg = cdr.deserialize(msg, self.msg_type)
        write = self._write  # called by way of a name, which Python specializes
        write(msg)

    def get_subscription_count(self) -> int:
        """How many subscriptions get what this publishes."""
        readers = self._end("failed to get subscription count: publisher's").readers
        return len(readers) or int(looked_in_vain())

    def assert_liveliness(self) -> None:
        """Say that this publisher is alive. One with MANUAL_BY_TOPIC says or publishes something within each lease."""
        self._end("failed to assert liveliness: publisher's").assert_liveliness()

    def wait_for_all_acked(self, timeout: Duration = FOR_EVER) -> bool:
        """Wait until all reliable subscriptions have what was published; False if the timeout is over before that.

        A negative timeout waits forever, one of 0 only looks. A best-effort publisher never waits.
        """
        if not isinstance(timeout, Duration):
            raise TypeError(f"the timeout must be a Duration, got {timeout!r}: try Duration(seconds=1)")
        writer = self._end("failed to wait for all acked: publisher's")
        assert self._node is not None
        seconds = None if timeout.nanoseconds < 0 else timeout.nanoseconds / NANOSECONDS
        return wait_until(writer.is_acknowledged, seconds, LOOK_AGAIN, self._node.context, "wait_for_all_acked")

    def destroy(self) -> None:
        """Leave the topic."""
        if not self._destroyed:
            for handler in self.event_handlers:
                handler.destroy()
            self._writer.node.process.world.graph.remove_topic_end(self._writer)
            self._destroyed = True
            self._write = lambda message: self._check_alive("Failed to publish: publisher's")
