"""A publisher's end of a topic: it knows the readers that its messages go to, and by which way."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from .endpoint import LIVELINESS, MATCHED, MESSAGE_LOST, End, Quality, Watchdog
from .reader import Reader
from .transport import BestEffortLine, Line, ReliableLine

if TYPE_CHECKING:
    from .graph import NodeEntry, Topic


class Writer(End):
    """A publisher's end. `readers` are those that it has met; `alive` is what they think of it.

    Most readers are served in the usual way, all at once. Those that want more, or whose topic is in a bad network,
    have a line of their own. What else is to be done with each message is decided beforehand (`arrange`), so that a
    plain publisher pays nothing for it.
    """

    def __init__(
        self, node: NodeEntry, topic: Topic, quality: Quality, note: Callable[[int], object] | None = None
    ) -> None:
        super().__init__(node, topic, quality)
        self.readers: tuple[Reader, ...] = ()
        self.alive = True
        self.note = note
        """Told the time (ns) of each message, where a trace is kept."""
        self._simulation = topic.simulation
        self._latency = topic.latency
        self._usual: tuple[Reader, ...] = ()
        self._lines: dict[Reader, Line] = {}
        self._kept: deque[tuple[int, Any]] | None = deque(maxlen=quality.depth) if quality.latched else None
        self._lease: Watchdog | None = None
        if quality.manual and quality.lease is not None:
            self._lease = Watchdog(topic.simulation, quality.lease, self._fall_silent, repeats=False)
            self._lease.renew()
        self._also: Callable[[Any], object] | None = None
        self.arrange()

    # -- sending ---------------------------------------------------------------------------------------------------

    def write(self, message: Any) -> None:
        """Send a message: a copy, rounded to the wire's precision, to every matched reader."""
        if self._idle:
            return
        now = self._simulation.now
        note, also = self.note, self._also
        if note is not None:
            note(now)
        if also is not None:
            also(message)
        if self._usual:
            self._simulation.at(now + self._latency, _deliver, (self, self._usual, message._wire_copy()))

    def _deliver_kept(self, parcel: tuple[Reader, Any, int]) -> None:
        reader, wire, sent = parcel
        reader.take_in(wire, sent)

    def arrange(self) -> None:
        """Decide again by which way each reader is served, and what else is done with each message."""
        for reader in self.readers:
            self._choose_way(reader)
        self._plan()

    def _choose_way(self, reader: Reader) -> None:
        special = reader.watches or self.quality.lifespan is not None or self.topic.conditions is not None
        if special and reader not in self._lines:
            self._lines[reader] = self._line_to(reader)
        if reader in self._lines:
            self._lines[reader].use(self.topic.conditions)

    def _plan(self) -> None:
        """Put together what is done with each message. Looks at the readers one by one only where some have lines."""
        lines = self._lines
        self._usual = tuple(reader for reader in self.readers if reader not in lines) if lines else self.readers
        steps: list[Callable[[Any], object]] = []
        if self._kept is not None:
            steps.append(self._keep)
        if self._deadline is not None:
            steps.append(self._deadline.renew)
        if self._lease is not None:
            steps.append(self.assert_liveliness)
        if self._lines:
            steps.append(self._send_by_lines)
        self._also = None if not steps else steps[0] if len(steps) == 1 else partial(_do_all, steps)
        self._idle = not steps and not self._usual and self.note is None

    def _line_to(self, reader: Reader) -> Line:
        lifespan = self.quality.lifespan
        deliver = reader.take_in if lifespan is None else partial(reader.take_in, lifespan=lifespan)
        told = partial(reader.happens, MESSAGE_LOST)
        ends = f"{self.topic.name} {self.node.full_name} {reader.node.full_name}"
        arguments = (self._simulation, self._latency, deliver, told, self.topic.network, ends)
        kind = ReliableLine if self.quality.reliable and reader.quality.reliable else BestEffortLine
        return kind(*arguments, depth=self.quality.depth)

    def _send_by_lines(self, message: Any) -> None:
        for line in self._lines.values():
            line.send(message._wire_copy(), self._simulation.now)

    def _keep(self, message: Any) -> None:
        """Keep a message for subscriptions that join late."""
        assert self._kept is not None
        self._forget_expired()
        self._kept.append((self._simulation.now, message._wire_copy()))

    def _forget_expired(self) -> None:
        lifespan, kept = self.quality.lifespan, self._kept
        while lifespan is not None and kept and kept[0][0] + lifespan <= self._simulation.now:
            kept.popleft()

    def under_way_to(self, reader: Reader) -> list[tuple[int, Any]]:
        """What was sent to a reader and has not arrived there yet: when (ns), and the message."""
        if reader in self._lines:
            return self._lines[reader].under_way()
        found = []
        for arrival, _, action, parcel in self._simulation.scheduled():
            if action is _deliver and parcel[0] is self and reader in parcel[1]:
                found.append((arrival - self._latency, parcel[2]))
            elif action == self._deliver_kept and reader is parcel[0]:
                found.append((parcel[2], parcel[1]))
        return found

    def is_acknowledged(self) -> bool:
        """Whether all reliable readers have got everything."""
        reliable = [reader for reader in self.readers if self.quality.reliable and reader.quality.reliable]
        return not any(
            self._lines[reader].is_busy() if reader in self._lines else self.under_way_to(reader) for reader in reliable
        )

    # -- meeting ---------------------------------------------------------------------------------------------------

    def connections(self) -> int:
        """See End."""
        return len(self.readers)

    def meet(self, reader: Reader) -> None:
        """Send to this reader, too: from now on, and what has been kept for subscriptions that join late."""
        self.readers = (*self.readers, reader)
        self._choose_way(reader)
        self._plan()
        for end in (self, reader):
            end.will_happen(MATCHED, 1, 1)
        reader.will_happen(LIVELINESS, *((1, 0) if self.alive else (0, 1)))
        if not (reader.quality.latched and reader.quality.reliable):
            return  # a late subscription asks for what was kept, as for what was lost
        self._forget_expired()
        line = self._lines.get(reader)
        for sent, wire in self._kept or ():
            if line is not None:
                line.send(wire._wire_copy(), sent)
            else:
                parcel = (reader, wire._wire_copy(), sent)
                self._simulation.at(self._simulation.now + self._latency, self._deliver_kept, parcel)

    def part(self, reader: Reader) -> None:
        """One of the two goes: send nothing more to this reader."""
        self.readers = tuple(each for each in self.readers if each is not reader)
        line = self._lines.pop(reader, None)
        if line is not None and any(each is self for each, _ in self.topic.writers):
            line.close()  # it is the reader that goes; if it is this publisher, what it has sent still arrives
        self._plan()
        for end in (self, reader):
            end.will_happen(MATCHED, 0, -1)
        reader.will_happen(LIVELINESS, *((-1, 0) if self.alive else (0, -1)))
        reader.misses()

    # -- deadline and liveliness -------------------------------------------------------------------------------------

    def assert_liveliness(self, _: object = None) -> None:
        """Show that this publisher lives. What it publishes shows that, too."""
        if self._lease is not None:
            self._lease.renew()
            if not self.alive:
                self.alive = True
                for reader in self.readers:
                    reader.will_happen(LIVELINESS, 1, -1)

    def _fall_silent(self, _: int) -> None:
        """The lease is over: this publisher counts as dead until it shows that it lives."""
        self.alive = False
        self.happens(LIVELINESS, 1)
        for reader in self.readers:
            reader.will_happen(LIVELINESS, -1, 1)
            reader.misses()

    def retire(self) -> None:
        """This publisher goes: nothing is late any more."""
        for watchdog in (self._deadline, self._lease):
            if watchdog is not None:
                watchdog.stop()


def _deliver(parcel: tuple[Writer, tuple[Reader, ...], Any]) -> None:
    """A message arrives at the readers that are served in the usual way."""
    writer, readers, wire = parcel
    now, last = writer._simulation.now, readers[-1]
    for reader in readers:
        reader.queue.append(wire if reader is last else wire._wire_copy())
        times, arrivals, wake = reader.times, reader.arrivals, reader.wake
        if times is not None:
            times.append((now - writer._latency, now))
        if arrivals is not None:
            arrivals.append(now)
        wake()


def _do_all(steps: list[Callable[[Any], object]], message: Any) -> None:
    for step in steps:
        step(message)
