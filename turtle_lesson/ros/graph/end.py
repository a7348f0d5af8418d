"""What publishers and subscriptions have in common: their place in the graph, and what has happened to them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .quality import Quality
from .tally import INCOMPATIBLE_QOS, MATCHED, Matches, Refusals, Tally

if TYPE_CHECKING:
    from .graph import NodeEntry
    from .topic import Topic


class End:
    """One end of a topic. `tallies` holds what somebody listens to, by kind (see tally.py); the rest is not counted."""

    def __init__(self, node: NodeEntry, topic: Topic, quality: Quality) -> None:
        self.node = node
        self.topic = topic
        self.quality = quality
        self.profile: Any = None
        """The profile that the program gave, for displays of this end."""
        self.tallies: dict[str, Tally] = {}

    def listen(self, kind: str) -> Tally:
        """Count from now on, or go on counting, how often something of this kind happens.

        What has happened already is reported to the first listener.
        """
        tally = self.tallies.get(kind)
        if tally is None:
            tally = self.tallies[kind] = self._tally_of(kind)
            if tally.news:
                self.topic.simulation.at(self.topic.soon, _tell, tally)
        return tally

    def happens(self, kind: str, what: Any = 1) -> None:
        """Something happens to this end now."""
        tally = self.tallies.get(kind)
        if tally is not None:
            tally.add(what)

    def will_happen(self, kind: str, what: Any = 1) -> None:
        """This end learns of something that has just happened to the other one, as soon as messages take to arrive."""
        if kind in self.tallies:
            self.topic.simulation.at(self.topic.soon, self._learn, (kind, what))

    def _learn(self, news: tuple[str, Any]) -> None:
        self.happens(*news)

    def is_refused(self, kind: str, what: Any = 1) -> None:
        """This end meets one that it cannot be connected with. Told a moment later, when somebody listens."""
        self.topic.simulation.at(self.topic.soon, self._learn, (kind, what))

    def connections(self) -> int:
        """With how many ends of the other side this one is connected."""
        raise NotImplementedError

    def _tally_of(self, kind: str) -> Tally:
        if kind == INCOMPATIBLE_QOS:
            return Refusals()
        if kind == MATCHED:
            return begun(Matches(), self.connections(), self.connections())
        return Tally()


def begun(pair: Any, first: int, second: int) -> Any:
    """A pair of numbers that begins with what is there already."""
    pair.move(first, second)
    pair.news = bool(first or second)
    return pair


def _tell(tally: Tally) -> None:
    if tally.news:
        tally.tell()
