"""Reading a bag message by message."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

from turtle_lesson.ros.bags.bag import Bag, open_bag
from turtle_lesson.ros.bags.contents import Message
from turtle_lesson.ros.bags.errors import BagError
from turtle_lesson.ros.bags.writer import STORAGES

from ._storage import BagMetadata, ConverterOptions, StorageFilter, StorageOptions, TopicMetadata, metadata_of, topic_of

NOT_OPEN = "Bag is not open. Call open() before reading."
NO_STORAGE = "No storage could be initialized from the inputs."


def get_registered_readers() -> set[str]:
    """How bags that can be read may be stored."""
    return set(STORAGES)


def opened(uri: str, storage_id: str) -> Bag:
    """A bag by its folder or file. Raises RuntimeError where there is none, or it is stored otherwise."""
    if storage_id not in ("", *STORAGES):
        raise RuntimeError(f"{NO_STORAGE} A bag is stored as {' or '.join(STORAGES)}, got {storage_id!r}")
    try:
        bag = open_bag(uri)
    except BagError as error:
        raise RuntimeError(f"{NO_STORAGE} {error}") from None
    if storage_id not in ("", bag.storage):
        raise RuntimeError(
            f"{NO_STORAGE} The bag '{uri}' is stored as {bag.storage!r}, not as {storage_id!r}: open it with "
            f"storage_id={bag.storage!r}, or record it with ros2 bag record -s {storage_id}"
        )
    return bag


class SequentialReader:
    """Reads the messages of a bag in the order of their times."""

    def __init__(self) -> None:
        self._bag: Bag | None = None
        self._options = StorageOptions("")
        self._passes: Callable[[str], bool] = _all
        self._coming: Iterator[Message] = iter(())
        self._ahead: Message | None = None

    def open(self, storage_options: StorageOptions, converter_options: ConverterOptions) -> None:
        """Open a bag, at its first message. Raises RuntimeError if that cannot be done."""
        converter_options._check()
        self._bag = opened(storage_options.uri, storage_options.storage_id)
        self._options = storage_options
        self.seek(0)

    def open_uri(self, uri: str) -> None:
        """Open a bag by its folder or file alone."""
        self.open(StorageOptions(uri), ConverterOptions())

    def close(self) -> None:
        """Let go of the bag."""
        self._bag, self._coming, self._ahead = None, iter(()), None

    def has_next(self) -> bool:
        """Whether there is another message that the filter lets through."""
        self._opened()
        while self._ahead is None or not self._passes(self._ahead.topic):
            self._ahead = next(self._coming, None)
            if self._ahead is None:
                return False
        return True

    def read_next(self) -> tuple[str, bytes, int]:
        """The next message: its topic, its bytes (for `deserialize_message`), its time in ns. RuntimeError at the end."""
        if not self.has_next():
            raise RuntimeError("Bag is at end. No next message.")
        message, self._ahead = self._ahead, None
        assert message is not None
        return message.topic, message.data, message.time

    def seek(self, timestamp: int) -> None:
        """Go on with the first message that is not older than a time (ns)."""
        first, last = max(timestamp, self._options.start_time_ns), self._options.end_time_ns
        messages = self._opened().messages()
        self._coming = (each for each in messages if each.time >= first and (last < 0 or each.time <= last))
        self._ahead = None

    def set_filter(self, storage_filter: StorageFilter) -> None:
        """Read only these topics from here on."""
        self._passes = _passing(storage_filter)

    def reset_filter(self) -> None:
        """Read all topics from here on."""
        self._passes = _all

    def get_all_topics_and_types(self) -> list[TopicMetadata]:
        """The topics in the bag."""
        return [topic_of(number, topic) for number, topic in enumerate(self._opened().topics, 1)]

    def get_metadata(self) -> BagMetadata:
        """What there is to know of the bag."""
        return metadata_of(self._opened())

    def _opened(self) -> Bag:
        if self._bag is None:
            raise RuntimeError(NOT_OPEN)
        return self._bag


class SequentialCompressionReader(SequentialReader):
    """The same: a bag says itself whether it is compressed."""


def _all(_: str) -> bool:
    return True


def _passing(wanted: StorageFilter) -> Callable[[str], bool]:
    inside = wanted.regex or wanted.topics_regex
    outside = wanted.regex_to_exclude or wanted.topics_regex_to_exclude

    def passes(topic: str) -> bool:
        if topic in wanted.exclude_topics or (outside and re.fullmatch(outside, topic)):
            return False
        if not wanted.topics and not inside:
            return True
        return topic in wanted.topics or bool(inside and re.fullmatch(inside, topic))

    return passes
