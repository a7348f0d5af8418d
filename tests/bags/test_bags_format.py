"""The form of a bag: what rosbag2 of Humble and of Jazzy, Foxglove and PlotJuggler look for when they open one.

Facts, of rosbag2: rosbag2_storage's yaml.hpp (which keys of metadata.yaml are read, as what, from which version on) and
qos.cpp (up to version 8 policies are numbers), rosbag2_storage_mcap's mcap_storage.cpp, rosbag2_storage_sqlite3's
sqlite_storage.cpp. Of MCAP: https://mcap.dev/spec and its registry (profile `ros2`, encodings `ros2msg` and `cdr`).
"""

from __future__ import annotations

import re
import sqlite3
import zlib
from pathlib import Path
from typing import Any

import pytest
import yaml
from bag_help import BEGIN, write_bag
from mcap.reader import make_reader
from mcap.records import Channel, Chunk, ChunkIndex, MessageIndex, Schema, Statistics
from mcap.stream_reader import StreamReader, breakup_chunk

COUNT = 100
HASH = re.compile(r"RIHS01_[0-9a-f]{64}")
ENDLESS = {"sec": 9_223_372_036, "nsec": 854_775_807}
PROFILE = {
    "history": 1,
    "depth": 7,
    "reliability": 1,
    "durability": 2,
    "deadline": ENDLESS,
    "lifespan": ENDLESS,
    "liveliness": 1,
    "liveliness_lease_duration": ENDLESS,
    "avoid_ros_namespace_conventions": False,
}


@pytest.fixture(scope="module")
def mcap(tmp_path_factory: Any) -> Path:
    """A bag with several chunks."""
    folder = tmp_path_factory.mktemp("bags") / "run"
    write_bag(folder, COUNT, size=2000)
    return folder


@pytest.fixture(scope="module")
def database(tmp_path_factory: Any) -> Path:
    """The same in SQLite."""
    folder = tmp_path_factory.mktemp("bags") / "run"
    write_bag(folder, COUNT, "sqlite3", size=2000)
    return folder


# ---------------------------------------------------------------- metadata.yaml


def as_rosbag2_reads(found: dict[str, Any]) -> dict[str, Any]:
    """Read metadata as yaml.hpp does: each key that its version has must be there, and of its type."""
    version = found["version"]
    stamp, stretch = "nanoseconds_since_epoch", "nanoseconds"

    def extent(of: dict[str, Any]) -> tuple[int, int, int]:
        numbers = of["starting_time"][stamp], of["duration"][stretch], of["message_count"]
        assert all(type(number) is int and 0 <= number < 1 << 63 for number in numbers)
        return numbers

    topics = {}
    for each in found["topics_with_message_count"]:
        about = each["topic_metadata"]
        assert all(type(about[key]) is str for key in ("name", "type", "serialization_format", "offered_qos_profiles"))
        if version >= 7:
            assert HASH.fullmatch(about["type_description_hash"])
        topics[about["name"]] = (
            about["type"],
            about["serialization_format"],
            yaml.safe_load(about["offered_qos_profiles"]) if about["offered_qos_profiles"] else [],
            each["message_count"],
        )
    assert all(type(name) is str for name in found["relative_file_paths"])
    assert (found["compression_format"], found["compression_mode"]) == ("", "")
    if version >= 6:
        assert found["custom_data"] is None  # what an empty map is written as
    if version >= 8:
        assert type(found["ros_distro"]) is str
    return {
        "storage": found["storage_identifier"],
        "extent": extent(found),
        "files": {file["path"]: extent(file) for file in found["files"]},
        "paths": found["relative_file_paths"],
        "topics": topics,
    }


EXTENT = (BEGIN, (COUNT - 1) * 10_000_000, 2 * COUNT)
TOPICS = {
    "/chatter": ("std_msgs/msg/String", "cdr", [PROFILE], COUNT),
    "/count": ("std_msgs/msg/Int32", "cdr", [], COUNT),
}


def metadata_of(folder: Path) -> dict[str, Any]:
    (found,) = yaml.safe_load((folder / "metadata.yaml").read_text("utf-8")).items()
    assert found[0] == "rosbag2_bagfile_information"
    return found[1]


@pytest.mark.parametrize(
    ("kind", "storage", "file"), [("mcap", "mcap", "run_0.mcap"), ("database", "sqlite3", "run_0.db3")]
)
def test_metadata_is_of_version_8_which_humble_and_jazzy_read(request: Any, kind: str, storage: str, file: str) -> None:
    found = metadata_of(request.getfixturevalue(kind))
    assert found["version"] == 8
    expected = {"storage": storage, "extent": EXTENT, "files": {file: EXTENT}, "paths": [file], "topics": TOPICS}
    assert as_rosbag2_reads(found) == expected


def test_an_empty_bag_begins_at_the_end_of_time_as_in_rosbag2(tmp_path: Path) -> None:
    from turtle_lesson.ros.bags.writer import BagWriter

    BagWriter(tmp_path / "b").close()
    assert as_rosbag2_reads(metadata_of(tmp_path / "b"))["extent"] == ((1 << 63) - 1, 0, 0)


# ---------------------------------------------------------------- MCAP


def records(mcap: Path) -> list[Any]:
    with (mcap / "run_0.mcap").open("rb") as file:
        return list(StreamReader(file, emit_chunks=True, validate_crcs=True).records)


def test_an_mcap_file_says_that_it_is_of_ros_2(mcap: Path) -> None:
    with (mcap / "run_0.mcap").open("rb") as file:
        reader = make_reader(file)
        assert reader.get_header().profile == "ros2"
        summary = reader.get_summary()
        (metadata,) = reader.iter_metadata()
    assert summary is not None
    assert [(each.name, each.encoding) for each in summary.schemas.values()] == [
        ("std_msgs/msg/String", "ros2msg"),
        ("std_msgs/msg/Int32", "ros2msg"),
    ]
    assert metadata.name == "rosbag2"
    assert yaml.safe_load(metadata.metadata["serialized_metadata"]) == metadata_of(mcap)


def test_channels_have_the_metadata_of_rosbag2_in_the_data_and_in_the_summary(mcap: Path) -> None:
    found = records(mcap)
    schemas = [record for record in found if isinstance(record, Schema)]
    channels = [record for record in found if isinstance(record, Channel)]
    chunked = [record for chunk in found if isinstance(chunk, Chunk) for record in breakup_chunk(chunk)]
    assert [record for record in chunked if isinstance(record, Schema)] == schemas
    assert [record for record in chunked if isinstance(record, Channel)] == channels
    hashes = {
        each["topic_metadata"]["name"]: each["topic_metadata"]
        for each in metadata_of(mcap)["topics_with_message_count"]
    }
    for channel, profiles in zip(channels, ([PROFILE], None), strict=True):
        assert channel.message_encoding == "cdr"
        assert channel.metadata.keys() == {"offered_qos_profiles", "topic_type_hash"}
        assert yaml.safe_load(channel.metadata["offered_qos_profiles"]) == profiles
        assert channel.metadata["topic_type_hash"] == hashes[channel.topic]["type_description_hash"]


def test_chunks_are_small_checked_and_indexed_and_the_statistics_are_right(mcap: Path) -> None:
    found = records(mcap)
    chunks = [record for record in found if isinstance(record, Chunk)]
    assert len(chunks) > 2
    assert all(chunk.compression == "" and chunk.uncompressed_crc == zlib.crc32(chunk.data) != 0 for chunk in chunks)
    assert max(len(chunk.data) for chunk in chunks) < 70_000
    (statistics,) = [record for record in found if isinstance(record, Statistics)]
    assert (statistics.message_count, statistics.chunk_count, statistics.channel_message_counts) == (
        2 * COUNT,
        len(chunks),
        {1: COUNT, 2: COUNT},
    )
    assert (statistics.message_start_time, statistics.message_end_time) == (BEGIN, BEGIN + EXTENT[1])
    indexed = sum(len(record.records) for record in found if isinstance(record, MessageIndex))
    assert indexed == 2 * COUNT
    places = [record.chunk_start_offset for record in found if isinstance(record, ChunkIndex)]
    data = (mcap / "run_0.mcap").read_bytes()
    assert [data[place] for place in places] == [0x06] * len(chunks)


# ---------------------------------------------------------------- SQLite


def test_a_database_has_the_tables_of_rosbag2(database: Path) -> None:
    connection = sqlite3.connect(f"file:{database / 'run_0.db3'}?mode=ro", uri=True)
    ask = lambda query: connection.execute(query).fetchall()  # noqa: E731
    tables = {
        name: [row[1] for row in ask(f"PRAGMA table_info({name})")]
        for (name,) in ask("SELECT name FROM sqlite_master WHERE type='table' AND name NOT LIKE 'sqlite_%'")
    }
    assert tables == {
        "schema": ["schema_version", "ros_distro"],
        "metadata": ["id", "metadata_version", "metadata"],
        "topics": ["id", "name", "type", "serialization_format", "offered_qos_profiles", "type_description_hash"],
        "message_definitions": ["id", "topic_type", "encoding", "encoded_message_definition", "type_description_hash"],
        "messages": ["id", "topic_id", "timestamp", "data"],
    }
    assert [row[0] for row in ask("SELECT schema_version FROM schema")] == [4]
    ((version, text),) = ask("SELECT metadata_version, metadata FROM metadata")
    assert (version, yaml.safe_load(text)) == (8, metadata_of(database))
    assert [(name, kind, yaml.safe_load(offered)) for _, name, kind, _, offered, _ in ask("SELECT * FROM topics")] == [
        ("/chatter", "std_msgs/msg/String", [PROFILE]),
        ("/count", "std_msgs/msg/Int32", None),
    ]
    definitions = ask(
        "SELECT topic_type, encoding, encoded_message_definition, type_description_hash FROM message_definitions"
    )
    assert [row[:3] for row in definitions] == [
        ("std_msgs/msg/String", "ros2msg", "string data\n"),
        ("std_msgs/msg/Int32", "ros2msg", "int32 data\n"),
    ]
    assert [row[3] for row in definitions] == [
        row[0] for row in ask("SELECT type_description_hash FROM topics ORDER BY id")
    ]
    assert ask("SELECT count(*), min(timestamp), max(timestamp), typeof(data) FROM messages") == [
        (2 * COUNT, BEGIN, BEGIN + EXTENT[1], "blob")
    ]
    assert ask("SELECT name FROM sqlite_master WHERE type='index'") == [("timestamp_idx",)]
    assert ask("PRAGMA integrity_check") == [("ok",)]
    connection.close()
