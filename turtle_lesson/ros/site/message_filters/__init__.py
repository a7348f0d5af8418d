"""Filters that messages run through: by subscription, by time, in a history, or in step with other topics.

Facts: ros2/message_filters, src/message_filters/__init__.py. What is of C++ alone (`TimeSequencer`, other policies of
synchronising) is not here either, nor is `Chain`.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from itertools import product
from typing import TYPE_CHECKING, Any

from rclpy._hints import explain_missing, no_node
from rclpy.clock import ROSClock
from rclpy.duration import Duration
from rclpy.logging import get_logger
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.time import Time

if not TYPE_CHECKING:
    __getattr__ = explain_missing(__name__)


class SimpleFilter:
    """Hands what comes out of it to callbacks."""

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., Any], tuple[Any, ...]]] = {}

    def registerCallback(self, cb: Callable[..., Any], *args: Any) -> int:
        """Have `cb(message, …, *args)` called for each output; returns the callback's number."""
        if not callable(cb):
            raise TypeError(f"a callback is expected, got {cb!r}: hand over the function itself, as in self.both")
        number = len(self.callbacks)
        self.callbacks[number] = (cb, args)
        return number

    def signalMessage(self, *msg: Any) -> None:
        """Hand messages to all callbacks."""
        for callback, more in list(self.callbacks.values()):
            callback(*msg, *more)


class Subscriber(SimpleFilter):
    """A subscription as a filter: `Subscriber(node, type, topic, qos_profile=10, …)`, as `create_subscription` has it."""

    def __init__(
        self, node: Node, msg_type: Any, topic: str, *, qos_profile: QoSProfile | int = 10, **kwargs: Any
    ) -> None:
        super().__init__()
        if not isinstance(node, Node):
            raise no_node(node)
        self.node, self.topic = node, topic
        self.sub = node.create_subscription(msg_type, topic, self.callback, qos_profile, **kwargs)

    def callback(self, msg: Any) -> None:
        """Called for each message that comes."""
        self.signalMessage(msg)

    def getTopic(self) -> str:
        """The topic's name, as it was given."""
        return self.topic

    def __getattr__(self, key: str) -> Any:
        """Everything else is the subscription's."""
        return getattr(object.__getattribute__(self, "sub"), key)


class Cache(SimpleFilter):
    """Keeps the last `cache_size` messages that come out of the filter `f`, in the order in which they come."""

    def __init__(self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False) -> None:
        super().__init__()
        self.connectInput(f)
        self.cache_size = cache_size
        self.allow_headerless = allow_headerless
        self.cache_msgs: list[Any] = []
        self.cache_times: list[Time] = []

    def connectInput(self, f: SimpleFilter) -> None:
        """Take messages from another filter."""
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """Keep a message; the oldest has to go if there are too many."""
        stamp = stamp_of(msg, self.allow_headerless, "message_filters_cache")
        if stamp is not None:
            self.cache_times.append(stamp)
            self.cache_msgs.append(msg)
            surplus = max(0, len(self.cache_msgs) - self.cache_size)
            del self.cache_times[:surplus], self.cache_msgs[:surplus]
            self.signalMessage(msg)

    def getInterval(self, from_stamp: Time, to_stamp: Time) -> list[Any]:
        """The messages of an interval of time, both ends included."""
        assert from_stamp <= to_stamp
        entries = zip(self.cache_times, self.cache_msgs, strict=True)
        return [msg for time, msg in entries if from_stamp <= time <= to_stamp]

    def getElemAfterTime(self, stamp: Time) -> Any:
        """The first message at this time or after it; None if there is none."""
        entries = zip(self.cache_times, self.cache_msgs, strict=True)
        return next((msg for time, msg in entries if time >= stamp), None)

    def getElemBeforeTime(self, stamp: Time) -> Any:
        """The last message at this time or before it; None if there is none."""
        entries = zip(reversed(self.cache_times), reversed(self.cache_msgs), strict=True)
        return next((msg for time, msg in entries if time <= stamp), None)

    def getLastestTime(self) -> Time | None:
        """The time of the last message (so it is spelt); None if there is none."""
        return self.cache_times[-1] if self.cache_times else None

    def getOldestTime(self) -> Time | None:
        """The time of the first message; None if there is none."""
        return self.cache_times[0] if self.cache_times else None

    def getLast(self) -> Any:
        """The first message that is as late as the last one; None if there is none."""
        return self.getElemAfterTime(self.cache_times[-1]) if self.cache_times else None


def stamp_of(msg: Any, allow_headerless: bool, logger: str) -> Time | None:
    """A message's time; None, with a warning, for a message without header where that is not allowed."""
    if hasattr(msg, "header") and hasattr(msg.header, "stamp"):
        stamp = msg.header.stamp
        return stamp if hasattr(stamp, "nanoseconds") else Time.from_msg(stamp)
    if allow_headerless:
        return ROSClock().now()
    text = "has no header with a stamp, so it is left out; with allow_headerless=True it counts as of when it comes"
    get_logger(logger).warning(f"a {type(msg).__name__} {text}")
    return None


Queue = dict[int, Any]
"""Messages by their stamp in nanoseconds."""


class TimeSynchronizer(SimpleFilter):
    """Calls back with one message of each filter in `fs` whenever their stamps are equal.

    `queue_size` is how many messages of each wait for the others; the oldest has to go if there are more.
    """

    def __init__(self, fs: Sequence[SimpleFilter], queue_size: int) -> None:
        super().__init__()
        self.connectInput(fs)
        self.queue_size = queue_size
        self.lock = threading.Lock()

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:
        """Take messages from these filters."""
        self.queues: list[Queue] = [{} for _ in fs]
        self.input_connections = [
            each.registerCallback(self.add, queue, index)
            for index, (each, queue) in enumerate(zip(fs, self.queues, strict=True))
        ]

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """A message has come out of one of the filters."""
        with self.lock:
            self._keep(msg, Time.from_msg(msg.header.stamp), my_queue)
            for stamp in sorted(set.intersection(*map(set, self.queues))):
                self._hand_out([stamp] * len(self.queues))

    def _keep(self, msg: Any, stamp: Time, queue: Queue) -> None:
        queue[stamp.nanoseconds] = msg
        while len(queue) > self.queue_size:
            del queue[min(queue)]

    def _hand_out(self, stamps: Sequence[int]) -> None:
        """Call back with the messages of these stamps, one of each queue, which are used up by it."""
        self.signalMessage(*(queue[stamp] for queue, stamp in zip(self.queues, stamps, strict=True)))
        for queue, stamp in zip(self.queues, stamps, strict=True):
            del queue[stamp]


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """The same for messages whose stamps lie less than `slop` seconds apart.

    With `allow_headerless` a message without header counts as of when it comes.
    """

    def __init__(
        self, fs: Sequence[SimpleFilter], queue_size: int, slop: float, allow_headerless: bool = False
    ) -> None:
        super().__init__(fs, queue_size)
        self.slop = Duration(seconds=slop)
        self.allow_headerless = allow_headerless

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """A message has come out of one of the filters."""
        stamp = stamp_of(msg, self.allow_headerless, "message_filters_approx")
        if stamp is None:
            return
        with self.lock:
            self._keep(msg, stamp, my_queue)
            for stamps in product(*self._candidates(stamp.nanoseconds, my_queue_index)):
                present = all(each in queue for each, queue in zip(stamps, self.queues, strict=True))
                if present and max(stamps) - min(stamps) < self.slop.nanoseconds:
                    self._hand_out(stamps)
                    return

    def _candidates(self, mine: int, my_index: int | None) -> list[list[int]]:
        """For each queue the stamps that are near enough to the new one, the nearest first."""
        slop = self.slop.nanoseconds
        return [
            [mine]
            if index == my_index
            else sorted((each for each in queue if abs(each - mine) <= slop), key=lambda each: abs(each - mine))
            for index, queue in enumerate(self.queues)
        ]
