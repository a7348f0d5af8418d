"""Topics: writers publish, readers have a queue. A message takes a moment to arrive, and arrives as a copy."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from .endpoint import INCOMPATIBLE_QOS, INCOMPATIBLE_TYPE, End
from .network import Conditions, Network
from .reader import Reader
from .transport import latency_of
from .writer import Writer

if TYPE_CHECKING:
    from ..sim.simulation import Simulation


class Topic:
    """A name with a type, and the two ends that meet there."""

    def __init__(self, simulation: Simulation, name: str, network: Network) -> None:
        self.simulation = simulation
        self.name = name
        self.network = network
        self.latency = latency_of(name)
        self.conditions = network.of(name)
        self.writers: list[tuple[Writer, str]] = []
        self.readers: list[tuple[Reader, str]] = []
        self._types: Counter[str] = Counter()

    @property
    def soon(self) -> int:
        """When (ns) news that travels now arrives."""
        return self.simulation.now + self.latency

    @property
    def types(self) -> list[str]:
        """The type names in use here, sorted: more than one is a mistake that ROS allows between processes."""
        return sorted(self._types)

    def use(self, conditions: Conditions | None) -> None:
        """Have messages travel under these conditions from now on; None for the usual ones."""
        if conditions != self.conditions:
            self.conditions = conditions
            for writer, _ in self.writers:
                writer.arrange()

    def add_writer(self, writer: Writer, type_name: str) -> None:
        """Let a new publisher meet the readers that are there."""
        self.writers.append((writer, type_name))
        self._types[type_name] += 1
        for reader, reader_type in self.readers:
            _introduce(writer, reader, reader_type == type_name)

    def add_reader(self, reader: Reader, type_name: str) -> None:
        """Let a new subscription meet the writers that are there."""
        self.readers.append((reader, type_name))
        self._types[type_name] += 1
        for writer, writer_type in self.writers:
            _introduce(writer, reader, writer_type == type_name)

    def remove(self, end: End) -> None:
        """Take a publisher or subscription away; messages under way to it are lost."""
        self.writers = [entry for entry in self.writers if entry[0] is not end]
        self.readers = [entry for entry in self.readers if entry[0] is not end]
        self._types = Counter(type_name for _, type_name in (*self.writers, *self.readers))
        if isinstance(end, Writer):
            end.retire()
            for reader in end.readers:
                end.part(reader)
        else:
            for writer, _ in self.writers:
                if end in writer.readers:
                    writer.part(end)


def _introduce(writer: Writer, reader: Reader, same_type: bool) -> None:
    """Connect two ends, or tell both why that cannot be."""
    policy = writer.quality.refusal(reader.quality)
    if not same_type:
        for end in (writer, reader):
            end.is_refused(INCOMPATIBLE_TYPE, 1)
    elif policy is None:
        writer.meet(reader)
    else:
        for end in (writer, reader):
            end.is_refused(INCOMPATIBLE_QOS, policy)
