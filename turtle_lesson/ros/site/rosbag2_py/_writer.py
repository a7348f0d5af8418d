"""Writing a bag message by message."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rosidl_runtime_py.utilities import get_message

from turtle_lesson.ros.bags.errors import BagError
from turtle_lesson.ros.bags.writer import STORAGES, BagWriter, is_there
from turtle_lesson.ros.world import current_process

from ._reader import NO_STORAGE
from ._storage import ConverterOptions, StorageOptions, TopicMetadata, get_default_storage_id


def get_registered_writers() -> set[str]:
    """How bags can be stored."""
    return set(STORAGES)


def get_registered_compressors() -> set[str]:
    """How bags can be compressed: not at all here."""
    return set()


def get_registered_serializers() -> set[str]:
    """The form of the messages' bytes."""
    return {"cdr"}


class SequentialWriter:
    """Writes a bag; it is complete when the writer is closed, or the program ends."""

    def __init__(self) -> None:
        self._bag: BagWriter | None = None
        self._types: dict[str, str] = {}

    def open(self, storage_options: StorageOptions, converter_options: ConverterOptions) -> None:
        """Begin a new bag, in a folder that is not there yet. Raises RuntimeError if that cannot be done."""
        converter_options._check()
        storage = storage_options.storage_id or get_default_storage_id()
        if storage not in STORAGES:
            raise RuntimeError(f"{NO_STORAGE} A bag is stored as {' or '.join(STORAGES)}, got {storage!r}")
        folder = Path(storage_options.uri).expanduser().absolute()
        try:
            if is_there(folder):
                raise RuntimeError(
                    f"Bag directory already exists ({storage_options.uri}), can't overwrite existing bag"
                )
            self._bag = BagWriter(folder, storage)
        except BagError as error:
            raise RuntimeError(f"{NO_STORAGE} {error}") from None
        self._types.clear()
        current_process().at_exit.append(self._bag.close)

    def create_topic(self, topic: TopicMetadata) -> None:
        """Make a topic known, before its first message. Raises RuntimeError for a type that is not there."""
        bag = self._opened()
        if topic.name in self._types:
            return
        try:
            message_class: Any = get_message(topic.type)
            bag.add_topic(topic.name, message_class, [])
        except (ValueError, AttributeError, ModuleNotFoundError) as error:
            raise RuntimeError(f"the topic {topic.name} cannot be written: {error}") from None
        self._types[topic.name] = message_class._TYPE_NAME

    def remove_topic(self, topic: TopicMetadata) -> None:
        """Take no more messages of a topic."""
        self._types.pop(topic.name, None)

    def write(self, topic_name: str, message: bytes, time: int, send_time: int | None = None) -> None:
        """Put in a message of a known topic, as `serialize_message(msg)` makes it, with the time (ns) it came at."""
        bag = self._opened()
        if not isinstance(message, (bytes, bytearray)) or not isinstance(time, int):
            wrong = (
                "the time in ns, as get_clock().now().nanoseconds" if isinstance(message, (bytes, bytearray)) else ""
            )
            raise TypeError(
                "write(): incompatible function arguments: write(topic_name, message, time) wants "
                f"{wrong or 'the bytes that rclpy.serialization.serialize_message(msg) returns'}"
            )
        if topic_name not in self._types:
            raise RuntimeError(f"Failed to write on topic '{topic_name}'. Call create_topic() before first write.")
        bag.write(topic_name, self._types[topic_name], time, bytes(message))

    def close(self) -> None:
        """Complete the bag."""
        if self._bag is not None:
            self._bag.close()
            self._bag = None

    def _opened(self) -> BagWriter:
        if self._bag is None or self._bag.closed:
            raise RuntimeError("Bag is not open. Call open() before writing.")
        return self._bag
