"""What bags are described with: options, filters, topics, metadata."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Any

from turtle_lesson.ros.bags.writer import FORMAT_VERSION

if TYPE_CHECKING:
    from turtle_lesson.ros.bags.bag import Bag, BagTopic

SECOND = 1_000_000_000


def get_default_storage_id() -> str:
    """How a bag is stored if nobody says how: mcap, as since Iron."""
    return "mcap"


@dataclass
class StorageOptions:
    """Where a bag is, and how it is stored: `mcap`, `sqlite3`, or '' for the default one. Times are in ns since 1970."""

    uri: str
    storage_id: str = ""
    max_bagfile_size: int = 0
    max_bagfile_duration: int = 0
    max_cache_size: int = 0
    storage_preset_profile: str = ""
    storage_config_uri: str = ""
    snapshot_mode: bool = False
    start_time_ns: int = -1
    end_time_ns: int = -1
    custom_data: dict[str, str] = field(default_factory=dict)


@dataclass
class ConverterOptions:
    """The form of the messages' bytes: always `cdr` here; '' means the same."""

    input_serialization_format: str = ""
    output_serialization_format: str = ""

    def _check(self) -> None:
        for form in (self.input_serialization_format, self.output_serialization_format):
            if form not in ("", "cdr"):
                raise RuntimeError(f"no converter for the serialization format {form!r}: here messages are 'cdr'")


@dataclass
class StorageFilter:
    """Which topics are read: named ones, and those whose name a regular expression fits; empty means all."""

    topics: list[str] = field(default_factory=list)
    topics_regex: str = ""
    topics_regex_to_exclude: str = ""
    regex: str = ""
    exclude_topics: list[str] = field(default_factory=list)
    regex_to_exclude: str = ""


_TOPIC_FIELDS = ("name", "type", "serialization_format", "offered_qos_profiles", "type_description_hash")


class TopicMetadata:
    """A topic of a bag: `TopicMetadata(name=…, type=…, serialization_format="cdr")`, since Jazzy with `id=0` before it."""

    id: int = 0
    name: str
    type: str
    serialization_format: str
    offered_qos_profiles: Any = ""
    type_description_hash: str = ""

    def __init__(self, *given: Any, **named: Any) -> None:
        fields = ("id", *_TOPIC_FIELDS) if given and isinstance(given[0], int) else _TOPIC_FIELDS
        values = dict(zip(fields, given, strict=False)) | named
        missing = [each for each in _TOPIC_FIELDS[:3] if each not in values]
        unknown = [each for each in values if each not in ("id", *_TOPIC_FIELDS)]
        if missing or unknown or len(given) > len(fields):
            problem = f"{missing[0]} is missing" if missing else f"there is no {unknown[0]}" if unknown else "too many"
            raise TypeError(
                f"__init__(): incompatible constructor arguments: {problem}. Write "
                "TopicMetadata(id=0, name='chatter', type='std_msgs/msg/String', serialization_format='cdr')"
            )
        vars(self).update(values)

    def __repr__(self) -> str:
        return f"<TopicMetadata {self.name}: {self.type}>"

    def equals(self, other: TopicMetadata) -> bool:
        """Whether name, type and form of the bytes are the same."""
        return all(getattr(self, each) == getattr(other, each) for each in _TOPIC_FIELDS[:3])


@dataclass
class TopicInformation:
    """A topic, and how many messages of it there are."""

    topic_metadata: TopicMetadata
    message_count: int


class BagDuration(timedelta):
    """A timedelta, as in Humble, that knows its nanoseconds, as an rclpy Duration does since Jazzy."""

    nanoseconds: int


class BagTime(datetime):
    """A datetime (UTC), as in Humble, that knows its nanoseconds, as an rclpy Time does since Jazzy."""

    nanoseconds: int


def bag_duration(nanoseconds: int) -> BagDuration:
    """How long something lasts."""
    duration = BagDuration(microseconds=nanoseconds / 1000)
    duration.nanoseconds = nanoseconds
    return duration


def bag_time(nanoseconds: int) -> BagTime:
    """When something was."""
    time = BagTime.fromtimestamp(nanoseconds / SECOND, UTC).replace(tzinfo=None)
    time.nanoseconds = nanoseconds
    return time


@dataclass
class FileInformation:
    """A file of a bag."""

    path: str
    starting_time: BagTime
    duration: BagDuration
    message_count: int


@dataclass
class BagMetadata:
    """What metadata.yaml says of a bag."""

    version: int = FORMAT_VERSION
    bag_size: int = 0
    storage_identifier: str = ""
    relative_file_paths: list[str] = field(default_factory=list)
    files: list[FileInformation] = field(default_factory=list)
    duration: BagDuration = field(default_factory=lambda: bag_duration(0))
    starting_time: BagTime = field(default_factory=lambda: bag_time(0))
    message_count: int = 0
    topics_with_message_count: list[TopicInformation] = field(default_factory=list)
    compression_format: str = ""
    compression_mode: str = ""
    custom_data: dict[str, str] = field(default_factory=dict)
    ros_distro: str = ""


def topic_of(number: int, topic: BagTopic) -> TopicMetadata:
    """A topic that was found in a bag."""
    return TopicMetadata(number, topic.name, topic.type_name, topic.serialization, topic.offered)


def metadata_of(bag: Bag) -> BagMetadata:
    """What there is to know of a bag."""
    start, duration = bag_time(bag.start or 0), bag_duration(bag.duration)
    names = [file.name for file in bag.files]
    return BagMetadata(
        bag_size=bag.size,
        storage_identifier=bag.storage,
        relative_file_paths=names,
        files=[FileInformation(name, start, duration, bag.message_count) for name in names],
        duration=duration,
        starting_time=start,
        message_count=bag.message_count,
        topics_with_message_count=[
            TopicInformation(topic_of(number, topic), topic.count) for number, topic in enumerate(bag.topics, 1)
        ],
        compression_format="zstd" if bag.compression else "",
        compression_mode=bag.compression.upper(),
        ros_distro=bag.distro,
    )
