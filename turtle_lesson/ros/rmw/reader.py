"""A subscription's end of a topic: a queue."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .endpoint import LIVELINESS, End, Quality, Tally
from .transport import nobody

if TYPE_CHECKING:
    from .graph import NodeEntry, Topic
    from .writer import Writer


class Reader(End):
    """A subscription's end: `queue` holds the messages that have arrived, oldest first; `wake` tells its owner."""

    def __init__(self, node: NodeEntry, topic: Topic, quality: Quality) -> None:
        super().__init__(node, topic, quality)
        self.queue: deque[Any] = deque(maxlen=quality.depth)
        self.times: deque[tuple[int, int]] | None = None
        self.arrivals: deque[int] | None = None
        """When each message that waits has come (ns), where a trace is kept."""
        self.wake: Callable[[], object] = nobody

    def keep_times(self) -> None:
        """From now on keep, beside each message, when it was sent and when it arrived (ns)."""
        if self.times is None:
            self.times = deque(maxlen=self.quality.depth)

    @property
    def watches(self) -> bool:
        """Whether each message has to be noted here, so that none may simply be put into the queue."""
        return self._deadline is not None

    def writers(self) -> list[Writer]:
        """The publishers that this subscription hears."""
        return [writer for writer, _ in self.topic.writers if self in writer.readers]

    def connections(self) -> int:
        """See End."""
        return len(self.writers())

    def arrange(self) -> None:
        """See End: it is the writers that decide."""
        for writer in self.writers():
            writer.arrange()

    def _tally_of(self, kind: str) -> Tally:
        if kind == LIVELINESS:
            writers = self.writers()
            alive = sum(writer.alive for writer in writers)
            return Tally(alive, len(writers) - alive)
        return super()._tally_of(kind)

    def misses(self) -> None:
        """A publisher has gone or is not alive: if none is left, no message is expected, and none is late."""
        if self._deadline is not None and not any(writer.alive for writer in self.writers()):
            self._deadline.stop()

    def take_in(self, wire: Any, sent: int, lifespan: int | None = None) -> None:
        """A message arrives that was sent at `sent` (ns), and is good for `lifespan` (ns) after that."""
        now = self.topic.simulation.now
        if lifespan is not None:
            if sent + lifespan <= now:
                return
            self.topic.simulation.at(sent + lifespan, self._expire, wire)
        if self._deadline is not None:
            self._deadline.renew()
        self.queue.append(wire)
        if self.times is not None:
            self.times.append((sent, now))
        if self.arrivals is not None:
            self.arrivals.append(now)
        self.wake()

    def _expire(self, wire: Any) -> None:
        """A message has become too old: nobody gets it any more, if it still waits."""
        for index, waiting in enumerate(self.queue):
            if waiting is wire:
                for queue in (self.queue, self.times, self.arrivals):
                    if queue is not None:
                        del queue[index]
                return

    def under_way(self) -> list[tuple[int, Any]]:
        """What was sent to this reader and has not arrived yet: when (ns), and the message, in their order."""
        found = [entry for writer in self.writers() for entry in writer.under_way_to(self)]
        return sorted(found, key=lambda entry: entry[0])
