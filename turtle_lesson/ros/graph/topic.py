"""Topics: writers publish, readers have a queue. A message takes a moment to arrive, and arrives as a copy."""

from __future__ import annotations

import zlib
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .quality import Quality

if TYPE_CHECKING:
    from ..core import Simulation
    from .graph import NodeEntry

LATENCY = 100_000
"""How long a message is under way, in ns: what a real rclpy needs from publish to callback is 81 to 107 µs. Each
name has its own few µs on top, so that of two messages sent at the same instant the order never depends on chance."""

LATENCY_SPREAD = 20_000


def latency_of(name: str) -> int:
    """The time, in ns, that messages of a topic (or requests of a service) are under way: fixed for each name."""
    return LATENCY + zlib.crc32(name.encode()) % LATENCY_SPREAD


def nobody() -> None:
    """What is called when data arrives for somebody who does not wait for it yet."""


class Reader:
    """A subscription's end: `queue` holds the messages that have arrived, oldest first; `wake` tells its owner."""

    def __init__(self, node: NodeEntry, topic: Topic, quality: Quality) -> None:
        self.node = node
        self.topic = topic
        self.quality = quality
        self.queue: deque[Any] = deque(maxlen=quality.depth)
        self.times: deque[tuple[int, int]] | None = None
        self.wake: Callable[[], object] = nobody
        self.on_mismatch: Callable[[str], None] | None = None

    def keep_times(self) -> None:
        """From now on keep, beside each message, when it was sent and when it arrived (ns)."""
        self.times = deque(maxlen=self.quality.depth)

    def under_way(self) -> list[tuple[int, Any]]:
        """What was sent to this reader and has not arrived yet: when (ns), and the message, in their order."""
        found = []
        for arrival, _, action, parcel in self.topic.simulation.scheduled():
            deliver = getattr(action, "__func__", None)
            if deliver is Writer._deliver and self in parcel[0]:
                found.append((arrival - self.topic.latency, parcel[1]))
            elif deliver is Writer._deliver_kept and self is parcel[0]:
                found.append((parcel[2], parcel[1]))
        return sorted(found, key=lambda entry: entry[0])


class Writer:
    """A publisher's end: knows the readers that its messages go to."""

    def __init__(self, node: NodeEntry, topic: Topic, quality: Quality) -> None:
        self.node = node
        self.topic = topic
        self.quality = quality
        self.readers: tuple[Reader, ...] = ()
        self.on_mismatch: Callable[[str], None] | None = None
        self.note: Callable[[int], object] | None = None
        """Told the time (ns) of each message, where a trace is kept."""
        self._kept: deque[tuple[int, Any]] | None = deque(maxlen=quality.depth) if quality.latched else None
        self._simulation = topic.simulation
        self._latency = topic.latency

    def write(self, message: Any) -> None:
        """Send a message: a copy, rounded to the wire's precision, to every matched reader."""
        simulation = self._simulation
        if self.note is not None:
            self.note(simulation.now)
        if self._kept is not None:
            self._kept.append((simulation.now, message._wire_copy()))
        if self.readers:
            wire = message._wire_copy()
            simulation.at(simulation.now + self._latency, self._deliver, (self.readers, wire))

    def _deliver(self, parcel: tuple[tuple[Reader, ...], Any]) -> None:
        readers, wire = parcel
        first = True
        for reader in readers:
            if first:
                reader.queue.append(wire)
                first = False
            else:
                reader.queue.append(wire._wire_copy())
            if reader.times is not None:
                now = self._simulation.now
                reader.times.append((now - self._latency, now))
            reader.wake()

    def greet(self, reader: Reader) -> None:
        """Send a reader that joins late what this writer has kept, if both want that."""
        if self._kept and reader.quality.latched:
            simulation = self._simulation
            for sent, wire in self._kept:
                parcel = (reader, wire._wire_copy(), sent)
                simulation.at(simulation.now + self._latency, self._deliver_kept, parcel)

    def _deliver_kept(self, parcel: tuple[Reader, Any, int]) -> None:
        reader, wire, sent = parcel
        reader.queue.append(wire)
        if reader.times is not None:
            reader.times.append((sent, self._simulation.now))
        reader.wake()


def _tell_mismatch(end: Writer | Reader, policy: str) -> None:
    if end.on_mismatch is not None:
        end.on_mismatch(policy)


class Topic:
    """A name with a type, and the two ends that meet there."""

    def __init__(self, simulation: Simulation, name: str) -> None:
        self.simulation = simulation
        self.name = name
        self.latency = latency_of(name)
        self.writers: list[tuple[Writer, str]] = []
        self.readers: list[tuple[Reader, str]] = []

    @property
    def types(self) -> list[str]:
        """The type names in use here, sorted: more than one is a mistake that ROS allows between processes."""
        return sorted({type_name for _, type_name in [*self.writers, *self.readers]})

    def add_writer(self, writer: Writer, type_name: str) -> None:
        """Let a new publisher meet the readers that are there."""
        self.writers.append((writer, type_name))
        for reader, reader_type in self.readers:
            if reader_type == type_name:
                self._introduce(writer, reader)

    def add_reader(self, reader: Reader, type_name: str) -> None:
        """Let a new subscription meet the writers that are there."""
        self.readers.append((reader, type_name))
        for writer, writer_type in self.writers:
            if writer_type == type_name:
                self._introduce(writer, reader)

    def _introduce(self, writer: Writer, reader: Reader) -> None:
        policy = writer.quality.refusal(reader.quality)
        if policy is None:
            writer.readers = (*writer.readers, reader)
            writer.greet(reader)
            return
        for end in (writer, reader):
            self.simulation.call_later(self.latency, _tell_mismatch, end, policy)

    def remove(self, end: Writer | Reader) -> None:
        """Take a publisher or subscription away; messages under way to it are lost."""
        self.writers = [entry for entry in self.writers if entry[0] is not end]
        self.readers = [entry for entry in self.readers if entry[0] is not end]
        for writer, _ in self.writers:
            if end in writer.readers:
                writer.readers = tuple(reader for reader in writer.readers if reader is not end)
