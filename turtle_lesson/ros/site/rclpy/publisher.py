"""Publishers."""

from __future__ import annotations

from typing import Any

from turtle_lesson.ros.graph import Writer

from ._mistakes import no_message
from .callback_groups import CallbackGroup
from .exceptions import refuse_destroyed
from .qos import QoSProfile


class Publisher:
    """Made by `Node.create_publisher`."""

    def __init__(self, writer: Writer, msg_type: type, topic: str, qos_profile: QoSProfile, logger_name: str) -> None:
        self._writer: Writer | None = writer
        self._write = writer.write
        self._simulation = writer.topic.simulation
        self.msg_type = msg_type
        self.topic = topic
        self.qos_profile = qos_profile
        self.event_handlers: list[Any] = []
        self.callback_group: CallbackGroup | None = None
        self._logger_name = logger_name

    def __repr__(self) -> str:
        return f"<Publisher of {self.topic}>"

    @property
    def topic_name(self) -> str:
        """The topic's full name."""
        return self._end().topic.name

    @property
    def handle(self) -> Any:
        """The publisher stands for itself: there is no C object beneath it."""
        return self

    @property
    def logger_name(self) -> str:
        """The name of the node's logger."""
        return self._logger_name

    def _end(self) -> Writer:
        if self._writer is None:
            refuse_destroyed(self._simulation)
        return self._writer

    def publish(self, msg: Any) -> None:
        """Send a message to all matched subscriptions. It is copied: changing `msg` later changes nothing sent.

        Raises TypeError for anything but a message of the publisher's type (or its CDR bytes).
        """
        if msg.__class__ is not self.msg_type and not isinstance(msg, self.msg_type):
            msg = self._from_bytes(msg)
        self._write(msg)

    def _from_bytes(self, msg: Any) -> Any:
        if not isinstance(msg, bytes):
            raise no_message(msg, self.msg_type)
        from .serialization import deserialize_message

        return deserialize_message(msg, self.msg_type)

    def get_subscription_count(self) -> int:
        """How many subscriptions get what this publishes."""
        return len(self._end().readers)

    def assert_liveliness(self) -> None:
        """Say that this publisher is alive; nothing here doubts it."""
        self._end()

    def wait_for_all_acked(self, timeout: Any = None) -> bool:
        """Whether everything has arrived: nothing is ever lost on the way here."""
        return True

    def destroy(self) -> None:
        """Leave the topic."""
        if self._writer is not None:
            self._writer.node.process.locals["world"].graph.remove_topic_end(self._writer)
            self._writer = None
            self._write = self._refuse

    def _refuse(self, message: Any) -> None:
        refuse_destroyed(self._simulation)
