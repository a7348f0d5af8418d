"""The data files of a bag, read as far as they can be read: a damaged one up to the damage, and no further.

Facts: https://mcap.dev/spec, and rosbag2_storage_sqlite3's sqlite_storage.cpp (tables `topics` and `messages`, and a newer one
for definitions). Of a damaged MCAP file, chunks whose size or checksum is wrong are left out. Files are read into memory;
compressed data is unpacked up to a limit, since a few kilobytes can stand for gigabytes: recordings of robots hardly ever
shrink to a hundredth.
"""

from __future__ import annotations

import sqlite3
import struct
import sys
import zlib
from collections.abc import Callable, Iterator
from contextlib import closing, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rosbags.interfaces import Qos

MAGIC = b"\x89MCAP0\r\n"
FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK = 2, 3, 4, 5, 6
HEAD = struct.Struct("<BQ")
MESSAGE_HEAD = struct.Struct("<HIQQ")
CHUNK_HEAD = struct.Struct("<QQQII")

LARGEST = 4 << 30
"""How many bytes a file may have, also when its chunks are unpacked."""

MOST_TIMES = 100
"""How many times its size a file may become when its chunks are unpacked."""

ALWAYS = 64 << 20
"""How many bytes it may become in any case."""

COMPUTED = (
    "SELECT 1 FROM sqlite_master AS it LEFT JOIN pragma_table_xinfo(it.name) AS its_column "
    "WHERE (sql NOT LIKE 'CREATE TABLE%' AND sql NOT LIKE 'CREATE INDEX%') OR its_column.hidden"
)
"""Finds views, virtual tables and generated columns, whose rows and values could be without end. rosbag2 makes none."""


@dataclass(eq=False)
class BagTopic:
    """A topic in a bag: name, type, form of the bytes, definition of the type, number of messages that can be read."""

    name: str
    type_name: str
    serialization: str
    definition: str
    offered: str
    count: int = 0

    @property
    def profiles(self) -> list[Qos]:
        """The quality of service that its publishers offered."""
        from rosbags.rosbag2.metadata import parse_qos

        try:
            return parse_qos(self.offered)
        except Exception:
            return []  # a spoiled or foreign description: the default will do


@dataclass
class Contents:
    """What the files of a bag hold, as far as it can be read.

    Attributes:
        topics: by name and type, for a bag may hold one name with several types, in the order in which they were found.
        messages: the time (ns), topic and CDR bytes of each, in the order of their times.
        flaws: a sentence for each thing that is wrong.
    """

    topics: dict[tuple[str, str], BagTopic] = field(default_factory=dict)
    messages: list[tuple[int, BagTopic, bytes | memoryview]] = field(default_factory=list)
    flaws: list[str] = field(default_factory=list)

    def topic(self, name: str, type_name: str, serialization: str, definition: str, offered: str) -> BagTopic:
        """The topic of this name and type, as it was described first."""
        topic = BagTopic(name, type_name, serialization, definition, offered)
        return self.topics.setdefault((name, type_name), topic)

    def add(self, time: int, topic: BagTopic, data: bytes | memoryview) -> None:
        """There is one more message."""
        topic.count += 1
        self.messages.append((time, topic, data))


class _Spoiled(Exception):
    """The file makes no sense from here on."""


def contents_of(files: list[Path]) -> Contents:
    """What all files of a bag hold."""
    found = Contents()
    for file in files:
        flaws: list[str] = []
        try:
            if file.stat().st_size > LARGEST:
                raise _Spoiled(f"it is larger than {LARGEST >> 30} GiB, and a bag is read into memory")
            READERS[file.suffix](file, found, flaws)
        except _Spoiled as error:
            flaws.append(str(error))
        except (OSError, MemoryError, sqlite3.Error, UnicodeError) as error:  # SQLite's own complaint may be unreadable
            reason = " ".join((str(getattr(error, "strerror", None) or error) or "too little memory").split())
            flaws.append(f"it cannot be read ({''.join(char if char.isprintable() else '?' for char in reason)})")
        found.flaws += [f"{file.name}: {flaw}" for flaw in flaws]
    found.messages.sort(key=lambda message: message[0])
    return found


# A record of MCAP is an opcode (1 byte), a length (8 bytes) and that many bytes. Messages lie in chunks, which may be
# compressed and may have a checksum; behind the last one comes a summary that says again what topics there are.


def _read_mcap(file: Path, found: Contents, flaws: list[str]) -> None:
    """Add what an MCAP file holds."""
    schemas: dict[int, tuple[str, str]] = {}
    channels: dict[int, BagTopic] = {}
    messages: list[tuple[int, int, memoryview]] = []
    try:
        for opcode, body in _sound_records(memoryview(file.read_bytes()), flaws):
            if opcode == MESSAGE:
                number, _, time, _ = MESSAGE_HEAD.unpack_from(body)
                messages.append((time, number, body[MESSAGE_HEAD.size :]))
            elif opcode == SCHEMA:
                name, _encoding, definition, *_ = _fields(body[2:])
                schemas[int.from_bytes(body[:2], "little")] = str(name, "utf-8"), str(definition, "utf-8")
            elif opcode == CHANNEL:
                number, schema = struct.unpack_from("<HH", body)
                topic, encoding, metadata, *_ = _fields(body[4:])
                noted = [str(text, "utf-8") for text in _fields(metadata)]
                offered = dict(zip(noted[::2], noted[1::2], strict=False)).get("offered_qos_profiles", "")
                type_name, text = schemas.get(schema, ("", ""))
                described = found.topic(str(topic, "utf-8"), type_name, str(encoding, "utf-8"), text, offered)
                channels.setdefault(number, described)
    except (struct.error, ValueError):
        flaws.append("one of its records makes no sense")
    except _Spoiled as error:
        flaws.append(str(error))
    for time, number, data in messages:
        if number in channels:
            found.add(time, channels[number], data)


def _sound_records(data: memoryview, flaws: list[str]) -> Iterator[tuple[int, memoryview]]:
    """Opcode and content of the records of a file, with those in chunks, up to a damage, for which it raises _Spoiled."""
    if data[: len(MAGIC)] != MAGIC:
        raise _Spoiled("it does not begin like an MCAP file")
    left = min(LARGEST, max(ALWAYS, MOST_TIMES * len(data)))
    has_chunks = False
    for place, opcode, length, body in _records(data, len(MAGIC)):
        if opcode == CHUNK and len(body) >= CHUNK_HEAD.size:
            has_chunks = True
            unpacked = memoryview(_unpacked(place, length, body, left, flaws))
            left -= len(unpacked)
            yield from ((opcode, inner) for _, opcode, size, inner in _records(unpacked, 0) if len(inner) == size)
        elif len(body) < length:
            break
        elif opcode == FOOTER:
            if data[place + HEAD.size + length :] != MAGIC:
                raise _Spoiled("its end is missing or damaged")
            return
        elif not (opcode == MESSAGE and has_chunks):  # a spoiled length can lead into a chunk
            yield opcode, body
    raise _Spoiled(f"it ends at byte {len(data)}, before its end record")


def _records(data: memoryview, at: int) -> Iterator[tuple[int, int, int, memoryview]]:
    """Place, opcode, length and content of the records from a byte on; the content of the last may be cut short."""
    while at + HEAD.size <= len(data) and data[at]:  # no record has the opcode 0: a crash may leave zeros at the end
        opcode, length = HEAD.unpack_from(data, at)
        yield at, opcode, length, data[at + HEAD.size : at + HEAD.size + length]
        at += HEAD.size + length


def _fields(data: memoryview) -> Iterator[memoryview]:
    """The texts that follow one another, each behind its length; also a map of texts is one such text."""
    while data:
        (length,) = struct.unpack_from("<I", data)
        if 4 + length > len(data):
            raise struct.error
        yield data[4 : 4 + length]
        data = data[4 + length :]


def _unpacked(place: int, length: int, body: memoryview, most: int, flaws: list[str]) -> bytes | memoryview:
    """The records of a chunk: fewer if it is cut short, none if it is damaged, which becomes a flaw.

    Raises _Spoiled if it would be unpacked to more than `most` bytes.
    """
    _, _, size, checksum, letters = CHUNK_HEAD.unpack_from(body)
    begin = CHUNK_HEAD.size + letters
    compression = bytes(body[CHUNK_HEAD.size : begin])
    records: bytes | memoryview = body[begin + 8 :]
    if compression:
        if size > most:
            why = f"more than {MOST_TIMES} times as large, or than {LARGEST >> 30} GiB, which is no usual recording"
            raise _Spoiled(f"the chunk at byte {place} is not unpacked: the file would become {why}")
        try:
            records = _decompressor(compression).decompress(records, size + 1)  # one byte more shows that it lies
        except Exception:
            records = b""  # spoiled
    cut_short = len(records) < size and len(body) < length
    if not cut_short and (len(records) != size or (checksum and zlib.crc32(records) != checksum)):
        flaws.append(
            f"the chunk at byte {place} is damaged (its size or checksum is wrong), so its messages are left out"
        )
        return b""
    return records


def _decompressor(compression: bytes) -> Any:
    """What unpacks a chunk, also one that is cut short. MCAP knows two ways."""
    if compression == b"lz4":
        from lz4.frame import LZ4FrameDecompressor as Decompressor
    elif sys.version_info >= (3, 14):
        from compression.zstd import ZstdDecompressor as Decompressor
    else:
        from backports.zstd import ZstdDecompressor as Decompressor
    return Decompressor()


def _read_sqlite(file: Path, found: Contents, flaws: list[str]) -> None:
    """Add what a database of SQLite holds."""
    left = file.stat().st_size
    with closing(sqlite3.connect(f"{file.absolute().as_uri()}?mode=ro&immutable=1", uri=True)) as database:
        database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, max(left, 1_000_000))  # no value is larger than its file
        database.text_factory = lambda raw: raw.decode(errors="replace")
        for (verdict,) in database.execute("PRAGMA integrity_check(1)"):
            if verdict != "ok":
                flaws.append(f"the database is damaged ({verdict.splitlines()[-1]})")
        ((size,),) = database.execute("SELECT page_count * page_size FROM pragma_page_count, pragma_page_size")
        if size != left:
            raise _Spoiled("the database is damaged (it is cut short)")  # SQLite would take what is missing for zeros
        if database.execute(COMPUTED).fetchone():
            raise _Spoiled("its tables are computed, not recorded")
        definitions: dict[str, str] = {}
        with suppress(sqlite3.Error):  # Humble's has none
            definitions = dict(
                database.execute("SELECT topic_type, encoded_message_definition FROM message_definitions")
            )
        topics = {
            number: found.topic(name, type_name, serialization, definitions.get(type_name, ""), offered)
            for number, name, type_name, serialization, offered in database.execute(
                "SELECT rowid, name, type, serialization_format, offered_qos_profiles FROM topics"
            )
        }
        for number, time, data in database.execute("SELECT topic_id, timestamp, data FROM messages"):
            message = data if isinstance(data, bytes) else b""
            left -= 1 + len(message)
            if left < 0:
                raise _Spoiled("its messages are larger than the file, so not all of them were recorded")
            if number in topics and isinstance(time, int):
                found.add(time, topics[number], message)


READERS: dict[str, Callable[[Path, Contents, list[str]], None]] = {".mcap": _read_mcap, ".db3": _read_sqlite}
