"""What is found in a bag's files: topics, messages, and what is wrong with the files."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple


class Message(NamedTuple):
    """One recorded message: its topic, its time (ns since 1970), its type, and its CDR bytes."""

    topic: str
    time: int
    type_name: str
    data: bytes


class TopicKey(NamedTuple):
    """A topic with its type: a bag may hold one name with several types."""

    name: str
    type_name: str


@dataclass
class TopicContents:
    """What is known of a topic: how many messages, the profiles that were offered (YAML), and the type's definition."""

    count: int = 0
    serialization: str = "cdr"
    offered: str = ""
    definition: str = ""


@dataclass
class Contents:
    """What one or several files hold, as far as it can be read.

    Attributes:
        topics: by name and type, in the order in which they were found.
        messages: all messages in the order of their times, if they were asked for.
        start, end: the times of the first and the last message (ns), None without messages.
        expected: how many messages the file itself says it holds, None where it does not say.
        flaws: a sentence for each thing that is wrong.
    """

    topics: dict[TopicKey, TopicContents] = field(default_factory=dict)
    messages: list[Message] = field(default_factory=list)
    start: int | None = None
    end: int | None = None
    expected: int | None = None
    flaws: list[str] = field(default_factory=list)

    @property
    def count(self) -> int:
        """How many messages can be read."""
        return sum(topic.count for topic in self.topics.values())

    def see(self, first: int, last: int) -> None:
        """There are messages from `first` to `last` (ns)."""
        self.start = first if self.start is None else min(first, self.start)
        self.end = last if self.end is None else max(last, self.end)

    def add(self, other: Contents) -> None:
        """Take in what another file of the same bag holds."""
        for key, topic in other.topics.items():
            mine = self.topics.setdefault(key, TopicContents(0, topic.serialization, topic.offered, topic.definition))
            mine.count += topic.count
        self.messages = sorted([*self.messages, *other.messages], key=lambda message: message.time)
        if other.start is not None and other.end is not None:
            self.see(other.start, other.end)
        known = self.expected is not None and other.expected is not None
        self.expected = (self.expected or 0) + (other.expected or 0) if known else None
        self.flaws += other.flaws
