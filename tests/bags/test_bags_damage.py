"""Damaged bags: what can be read is read, what is lost is told, and nothing that was not recorded ever appears."""

from __future__ import annotations

import shutil
import sqlite3
import struct
import tracemalloc
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
import yaml
from bag_help import write_bag
from hypothesis import example, given
from hypothesis import strategies as st

from turtle_lesson.ros.bags import BagError, scan
from turtle_lesson.ros.bags.bag import Bag, info_text, open_bag

COUNT = 100
Written = list[tuple[str, int, bytes]]


class Sound(tuple[Path, Written]):
    """A folder and what was written; hypothesis would warn of a long repr."""

    def __repr__(self) -> str:
        return f"<{data_file(self[0]).name}>"


@pytest.fixture(scope="module", params=["mcap", "sqlite3"])
def sound(request: Any, tmp_path_factory: Any) -> Sound:
    """A sound bag of 200 messages, with what is in it."""
    folder = tmp_path_factory.mktemp("sound") / "run"
    return Sound((folder, write_bag(folder, COUNT, request.param, size=2000)))


def read(bag: Bag) -> Written:
    return [(message.topic, message.time, message.data) for message in bag.messages()]


def data_file(folder: Path) -> Path:
    return next(path for path in folder.iterdir() if path.suffix in {".mcap", ".db3"})


def spoil(sound: Sound, tmp_path: Path, change: Any) -> Path:
    """A copy of the sound bag, whose data file's bytes are what `change` makes of them."""
    folder = tmp_path / "spoiled"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(sound[0], folder)
    file = data_file(folder)
    file.write_bytes(change(bytearray(file.read_bytes())))
    return folder


def test_a_sound_bag_is_read_as_written(sound: Sound) -> None:
    bag = open_bag(sound[0])
    assert (bag.damage, bag.lost, bag.message_count) == ("", 0, 2 * COUNT)
    assert sorted(read(bag)) == sorted(sound[1])
    file = open_bag(data_file(sound[0]))
    assert (file.damage, file.message_count) == ("", 2 * COUNT)
    assert sorted(read(file)) == sorted(sound[1])


def test_half_a_bag_is_half_read_and_the_rest_is_counted(sound: Sound, tmp_path: Path) -> None:
    """MCAP only: SQLite reads no file that is cut short, and a recorder that is killed leaves a whole one."""
    if data_file(sound[0]).suffix != ".mcap":
        with pytest.raises(BagError, match=r"the database is damaged \(it is cut short"):
            open_bag(spoil(sound, tmp_path, lambda data: data[:-1]))
        return
    bag = open_bag(spoil(sound, tmp_path, lambda data: data[: len(data) // 2]))
    messages = read(bag)
    assert 0.35 * len(sound[1]) < len(messages) < 0.6 * len(sound[1])
    assert set(messages) < set(sound[1])
    assert (len(messages), bag.lost) == (bag.message_count, len(sound[1]) - len(messages))
    assert bag.damage.startswith("the bag is damaged: run_0")
    assert bag.damage.endswith(f". {len(messages)} of 200 messages can be read, {bag.lost} are lost")


def test_zeros_that_a_crash_left_are_the_end(sound: Sound, tmp_path: Path) -> None:
    if data_file(sound[0]).suffix != ".mcap":
        pytest.skip("SQLite reads no file that is cut short")
    bag = open_bag(spoil(sound, tmp_path, lambda data: data[: len(data) // 2] + bytes(10_000_000)))
    assert set(read(bag)) < set(sound[1])
    assert bag.message_count > 0 and bag.damage


def test_one_spoiled_byte_costs_one_chunk(sound: Sound, tmp_path: Path) -> None:
    """MCAP only: SQLite has no checksums, so a spoiled byte within a message is not noticed there."""
    if data_file(sound[0]).suffix != ".mcap":
        pytest.skip("no checksums")

    def change(data: bytearray) -> bytearray:
        data[len(data) // 2] ^= 0x10
        return data

    bag = open_bag(spoil(sound, tmp_path, change))
    assert set(read(bag)) < set(sound[1])
    assert bag.lost is not None
    assert 0 < bag.lost < 80
    assert "is damaged (its size or checksum is wrong), so its messages are left out" in bag.damage


def test_cut_short_at_every_twentieth_the_more_there_is_the_more_is_read(sound: Sound, tmp_path: Path) -> None:
    if data_file(sound[0]).suffix != ".mcap":
        pytest.skip("SQLite reads no file that is cut short")
    counts = []
    for part in range(20):
        folder = spoil(sound, tmp_path, lambda data, part=part: data[: len(data) * part // 20])
        try:
            bag = open_bag(folder)
        except BagError as error:
            assert part < 3
            assert "can be read: run_0" in str(error)
            counts.append(0)
            continue
        messages = read(bag)
        assert "is damaged: " in bag.damage
        assert set(messages) <= set(sound[1])
        assert len(messages) == bag.message_count == len(set(messages))
        assert bag.message_count + (bag.lost or 0) == 2 * COUNT
        counts.append(len(messages))
    assert counts == sorted(counts)
    assert counts[19] > 0.85 * 2 * COUNT


@given(part=st.floats(0, 1))
def test_cut_short_anywhere(sound: Sound, tmp_path: Path, part: float) -> None:
    folder = spoil(sound, tmp_path, lambda data: data[: int(part * (len(data) - 1))])
    try:
        bag = open_bag(folder)
    except BagError as error:
        assert "can be read: run_0" in str(error)
        return
    assert bag.damage
    assert set(read(bag)) <= set(sound[1])
    assert bag.message_count + (bag.lost or 0) == 2 * COUNT


@example(places=[(0.75, 1), (0.6328604590396264, 56)])
@given(places=st.lists(st.tuples(st.floats(0, 1), st.integers(1, 255)), min_size=1, max_size=20))
def test_spoiled_bytes_anywhere(sound: Sound, tmp_path: Path, places: list[tuple[float, int]]) -> None:
    def change(data: bytearray) -> bytearray:
        for place, bits in places:
            data[int(place * (len(data) - 1))] ^= bits
        return data

    try:
        bag = open_bag(spoil(sound, tmp_path, change))
        messages = read(bag)
    except BagError:
        return
    if bag.storage == "mcap" and bag.damage:
        assert {message[1:] for message in messages} <= {message[1:] for message in sound[1]}
    assert len(messages) <= 2 * COUNT + 10


def test_what_sqlite_says_of_a_spoiled_table_is_told_in_one_line(tmp_path: Path) -> None:
    write_bag(tmp_path / "run", 1, "sqlite3")
    file = tmp_path / "run" / "run_0.db3"
    file.write_bytes(file.read_bytes().replace(b"CREATE TABLE topics(", b"CREATE TABLE topics\0"))
    with pytest.raises(BagError, match=r"malformed database schema") as raised:
        open_bag(tmp_path / "run")
    assert str(raised.value).isprintable()


def test_a_database_whose_index_is_spoiled_is_read_without_it(tmp_path: Path) -> None:
    written = write_bag(tmp_path / "run", COUNT, "sqlite3")
    file = tmp_path / "run" / "run_0.db3"
    connection = sqlite3.connect(file)
    (page,) = connection.execute("SELECT rootpage FROM sqlite_master WHERE name = 'timestamp_idx'").fetchone()
    (size,) = connection.execute("PRAGMA page_size").fetchone()
    connection.close()
    data = bytearray(file.read_bytes())
    data[page * size - 2000 : page * size - 1990] = bytes(10)  # within the entries of the index
    file.write_bytes(data)
    bag = open_bag(tmp_path / "run")
    assert "the database is damaged" in bag.damage
    assert sorted(read(bag)) == sorted(written)


@given(data=st.binary(max_size=300), begin=st.sampled_from([b"", b"\x89MCAP0\r\n", b"SQLite format 3\0"]))
def test_rubbish_is_no_bag(tmp_path: Path, data: bytes, begin: bytes) -> None:
    for name in ("x.mcap", "x.db3"):
        (tmp_path / name).write_bytes(begin + data)
        with pytest.raises(BagError, match=r"nothing of the bag .* can be read: x\."):
            open_bag(tmp_path / name)


# ---------------------------------------------------------------- the rest of the folder


def test_without_metadata_the_data_is_read(sound: Sound, tmp_path: Path) -> None:
    folder = spoil(sound, tmp_path, lambda data: data)
    (folder / "metadata.yaml").unlink()
    bag = open_bag(folder)
    assert "there is no metadata.yaml (was the recording not stopped?)" in bag.damage
    assert bag.message_count == len(read(bag)) == 2 * COUNT


@pytest.mark.parametrize("text", ["", "- 1", "\0", "rosbag2_bagfile_information: 3", "a: &a [*a, *a]", "x" * 10_000])
def test_spoiled_metadata_is_told(sound: Sound, tmp_path: Path, text: str) -> None:
    folder = spoil(sound, tmp_path, lambda data: data)
    (folder / "metadata.yaml").write_text(text)
    bag = open_bag(folder)
    assert "metadata.yaml cannot be read" in bag.damage
    assert len(read(bag)) == 2 * COUNT


NONSENSE: st.SearchStrategy[Any] = (
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5) | st.just({}) | st.just([{}])
)
KEYS = ["version", "storage_identifier", "relative_file_paths", "duration", "starting_time", "message_count", "files"]


@given(lies=st.dictionaries(st.sampled_from([*KEYS, "topics_with_message_count", "compression_format"]), NONSENSE))
@example(lies={"files": ""})
@example(lies={"relative_file_paths": {}})
def test_metadata_that_lies_never_hides_what_is_there(sound: Sound, tmp_path: Path, lies: dict[str, Any]) -> None:
    folder = spoil(sound, tmp_path, lambda data: data)
    found = yaml.safe_load((folder / "metadata.yaml").read_text())
    found["rosbag2_bagfile_information"].update(lies)
    (folder / "metadata.yaml").write_text(yaml.safe_dump(found))
    bag = open_bag(folder)
    assert bag.message_count == 2 * COUNT
    assert sorted(read(bag)) == sorted(sound[1])
    assert info_text(bag).count("Topic: /") == 2


def test_files_that_are_none(tmp_path: Path) -> None:
    for name in ("x.mcap", "x.db3"):
        (tmp_path / name).touch()
        with pytest.raises(BagError, match=r"nothing of the bag .* can be read: x\."):
            open_bag(tmp_path / name)
        (tmp_path / name).unlink()
    (tmp_path / "y" / "y_0.mcap").mkdir(parents=True)
    with pytest.raises(BagError, match=r"there is no \.mcap or \.db3 file in it"):
        open_bag(tmp_path / "y")
    (tmp_path / "y" / "metadata.yaml").mkdir()
    with pytest.raises(BagError, match=r"there is no \.mcap or \.db3 file in it"):
        open_bag(tmp_path / "y")
    with pytest.raises(BagError, match="is not a bag"):
        open_bag(tmp_path / "y" / "y_0.mcap")


def test_a_file_outside_of_the_bag_is_never_read(sound: Sound, tmp_path: Path) -> None:
    folder = spoil(sound, tmp_path, lambda data: data)
    secret = tmp_path / data_file(folder).name
    data_file(folder).rename(secret)
    text = (folder / "metadata.yaml").read_text()
    (folder / "metadata.yaml").write_text(text.replace(secret.name, f"../{secret.name}"))
    with pytest.raises(BagError, match=r"is not a bag: there is no .mcap or .db3 file in it"):
        open_bag(folder)


def test_a_missing_file_of_several(tmp_path: Path) -> None:
    write_bag(tmp_path / "run", 10)
    text = (tmp_path / "run" / "metadata.yaml").read_text()
    text = text.replace("  - run_0.mcap\n", "  - run_0.mcap\n  - run_1.mcap\n").replace(
        "message_count: 20", "message_count: 40"
    )
    (tmp_path / "run" / "metadata.yaml").write_text(text)
    bag = open_bag(tmp_path / "run")
    assert bag.damage == (
        "the bag is damaged: the file run_1.mcap is missing. 20 of 40 messages can be read, 20 are lost"
    )
    assert len(read(bag)) == 20


def test_no_bag_at_all(tmp_path: Path) -> None:
    with pytest.raises(BagError, match="does not exist"):
        open_bag(tmp_path / "nothing")
    with pytest.raises(BagError, match=r"is not a bag: there is no .mcap or .db3"):
        open_bag(tmp_path)
    (tmp_path / "notes.txt").write_text("hello")
    with pytest.raises(BagError, match="is not a bag: a bag is a folder"):
        open_bag(tmp_path / "notes.txt")


# ---------------------------------------------------------------- what others write


def test_compressed_chunks_are_read_whole_and_cut_short(tmp_path: Path) -> None:
    """As `ros2 bag record --storage-preset-profile zstd_fast` writes them."""
    from mcap_ros2.writer import Writer

    path = tmp_path / "other.mcap"
    with Writer(str(path), chunk_size=20_000) as writer:  # zstd is its default
        schema = writer.register_msgdef("std_msgs/msg/Int32", "int32 data")
        for number in range(5000):
            writer.write_message("/count", schema, {"data": number}, log_time=number)
    bag = open_bag(path)
    assert (bag.damage, bag.message_count, bag.topics[0].type_name) == ("", 5000, "std_msgs/msg/Int32")
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    bag = open_bag(path)
    messages = read(bag)
    assert bag.damage
    assert 1000 < len(messages) < 4000
    assert [int.from_bytes(data[4:], "little") for _, _, data in messages] == list(range(len(messages)))


@pytest.mark.parametrize("mode", ["FILE", "MESSAGE"])
def test_a_bag_that_is_compressed_as_a_whole_is_refused(tmp_path: Path, mode: str) -> None:
    from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

    writer = Writer(tmp_path / "run", version=9, storage_plugin=StoragePlugin.SQLITE3)
    writer.set_compression(CompressionMode[mode], CompressionFormat.ZSTD)
    with writer:
        writer.add_connection("/count", "std_msgs/msg/Int32", msgdef="int32 data\n", rihs01="RIHS01_0")
    for metadata in (True, False)[: 1 + (mode == "FILE")]:
        if not metadata:
            (tmp_path / "run" / "metadata.yaml").unlink()
        with pytest.raises(BagError, match="was recorded with --compression-mode, which is not read here"):
            open_bag(tmp_path / "run")


def test_a_database_of_humble_is_read(tmp_path: Path) -> None:
    """Humble's has no definitions, no hashes and no schema table."""
    folder = tmp_path / "old"
    folder.mkdir()
    database = sqlite3.connect(folder / "old_0.db3")
    database.executescript(
        """
        CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
            serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);
        CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
            data BLOB NOT NULL);
        INSERT INTO topics VALUES(1, '/count', 'std_msgs/msg/Int32', 'cdr', '');
        INSERT INTO messages VALUES(1, 1, 5, x'0001000007000000');
        """
    )
    database.commit()
    database.close()
    bag = open_bag(folder / "old_0.db3")
    assert (bag.damage, bag.message_count, bag.topics[0].definition, bag.topics[0].profiles) == ("", 1, "", [])
    assert read(bag) == [("/count", 5, bytes.fromhex("0001000007000000"))]


# ---------------------------------------------------------------- bags that are far larger than they look


@pytest.fixture(autouse=True)
def _nothing_is_unpacked_beyond_the_limit(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A limit of 1 MiB, so that these tests need little memory; real recordings of this file stay far below it."""
    monkeypatch.setattr(scan, "ALWAYS", 1 << 20)
    yield


def packed_zeros(size: int = 64 << 20) -> bytes:
    """Some kilobytes of zstd that become as many zeros as are asked for."""
    import zstandard

    return zstandard.ZstdCompressor().compress(bytes(size))


def mcap_of(*records: tuple[int, bytes]) -> bytes:
    """An MCAP file without a summary."""
    end = (0x0F, bytes(4)), (0x02, bytes(20))
    written = b"".join(struct.pack("<BQ", code, len(body)) + body for code, body in (*records, *end))
    return b"\x89MCAP0\r\n" + written + b"\x89MCAP0\r\n"


def chunk(packed: bytes, size: int, compression: bytes = b"zstd") -> tuple[int, bytes]:
    """A chunk that says it holds so many bytes."""
    head = struct.pack("<QQQI", 0, 0, size, 0)
    return 0x06, head + struct.pack("<I", len(compression)) + compression + struct.pack("<Q", len(packed)) + packed


def packed_lz4(size: int) -> bytes:
    import lz4.frame

    return lz4.frame.compress(bytes(size))


@pytest.mark.parametrize("lies", [False, True])
@pytest.mark.parametrize(("compression", "pack"), [(b"zstd", packed_zeros), (b"lz4", packed_lz4)])
def test_a_small_chunk_that_holds_gigabytes_is_not_unpacked(
    compression: bytes, pack: Any, lies: bool, tmp_path: Path
) -> None:
    path = tmp_path / "bomb.mcap"
    path.write_bytes(mcap_of(chunk(pack(64 << 20), 100 if lies else 64 << 20, compression)))
    said = "its size or checksum is wrong" if lies else "would become more than 100 times as large"
    tracemalloc.start()
    try:
        with pytest.raises(BagError, match=rf"nothing of the bag .* can be read: .*the chunk at byte 8 .*{said}"):
            open_bag(path)
        assert tracemalloc.get_traced_memory()[1] < 8 << 20
    finally:
        tracemalloc.stop()


def test_many_small_chunks_are_one_large_one(tmp_path: Path) -> None:
    """Each is within the limit, and all together are not."""
    path = tmp_path / "bomb.mcap"
    path.write_bytes(mcap_of(*[chunk(packed_zeros(1 << 19), 1 << 19)] * 4))
    with pytest.raises(BagError, match="is not unpacked: the file would become more than 100 times as large"):
        open_bag(path)


def test_nothing_is_unpacked_beyond_the_size_that_a_file_may_have(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scan, "LARGEST", 1 << 18)
    path = tmp_path / "bomb.mcap"
    path.write_bytes(mcap_of(chunk(packed_zeros(1 << 19), 1 << 19)))
    with pytest.raises(BagError, match="100 times as large, or than 0 GiB"):
        open_bag(path)


@pytest.mark.parametrize(
    "messages",
    [
        "VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM n) "
        "SELECT id, 1 AS topic_id, id AS timestamp, x'00' AS data FROM n",
        "TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB AS (zeroblob(100000)))",
        "TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB AS (zeroblob(1000000000)))",
        "VIRTUAL TABLE messages USING fts5(topic_id, timestamp, data)",
    ],
)
def test_a_database_that_computes_its_messages_is_not_believed(tmp_path: Path, messages: str) -> None:
    path = tmp_path / "bomb.db3"
    with closing(sqlite3.connect(path)) as database:
        database.executescript(
            "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, "
            "offered_qos_profiles TEXT); INSERT INTO topics VALUES(1, '/count', 'std_msgs/msg/Int32', 'cdr', '');"
        )
        database.execute(f"CREATE {messages}")
        if messages.startswith("TABLE"):
            database.execute("INSERT INTO messages VALUES (1, 1, 1), (2, 1, 1)")
        database.commit()
    with pytest.raises(BagError, match="its tables are computed, not recorded"):
        open_bag(path)


LAUGHS = "x0: &x0 [y]\n" + "".join(f"x{n}: &x{n} [{', '.join([f'*x{n - 1}'] * 10)}]\n" for n in range(1, 9))


@pytest.mark.parametrize("text", [LAUGHS, "[" * 5000 + "]" * 5000, "#" * 11_000_000])
def test_metadata_that_would_grow_is_not_read(sound: Sound, tmp_path: Path, text: str) -> None:
    folder = spoil(sound, tmp_path, lambda data: data)
    with (folder / "metadata.yaml").open("a") as file:
        file.write(f"\nmore: {text}" if text[0] == "[" else f"\n{text}")
    bag = open_bag(folder)
    assert "metadata.yaml cannot be read (" in bag.damage
    assert len(read(bag)) == 2 * COUNT
