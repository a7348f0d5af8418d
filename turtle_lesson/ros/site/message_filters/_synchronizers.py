"""Messages of several topics that belong together, because they were made at the same time, or nearly so."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from itertools import product
from typing import Any

from rclpy.clock import ROSClock
from rclpy.duration import Duration
from rclpy.time import Time

from ._filters import SimpleFilter
from ._stamps import stamp_of

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

    Args:
        allow_headerless: whether messages without header are taken, with the time at which they come.
        sync_arrival_time: whether that time counts for all messages (newer releases).
    """

    def __init__(
        self,
        fs: Sequence[SimpleFilter],
        queue_size: int,
        slop: float,
        allow_headerless: bool = False,
        sync_arrival_time: bool = False,
    ) -> None:
        super().__init__(fs, queue_size)
        self.slop = Duration(seconds=slop)
        self.allow_headerless = allow_headerless
        self.sync_arrival_time = sync_arrival_time

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """A message has come out of one of the filters."""
        stamp = self._stamp(msg)
        if stamp is None:
            return
        with self.lock:
            self._keep(msg, stamp, my_queue)
            for stamps in product(*self._candidates(stamp.nanoseconds, my_queue_index)):
                if self._fit(stamps):
                    self._hand_out(stamps)
                    return

    def _stamp(self, msg: Any) -> Time | None:
        if self.sync_arrival_time:
            return ROSClock().now()
        return stamp_of(msg, self.allow_headerless, "message_filters_approx")

    def _candidates(self, mine: int, my_index: int | None) -> list[list[int]]:
        """For each queue the stamps that are near enough to the new one, the nearest first."""
        slop = self.slop.nanoseconds
        return [
            [mine]
            if index == my_index
            else sorted((each for each in queue if abs(each - mine) <= slop), key=lambda each: abs(each - mine))
            for index, queue in enumerate(self.queues)
        ]

    def _fit(self, stamps: Sequence[int]) -> bool:
        apart = max(stamps) - min(stamps)
        present = all(stamp in queue for stamp, queue in zip(stamps, self.queues, strict=True))
        return apart < self.slop.nanoseconds and present
