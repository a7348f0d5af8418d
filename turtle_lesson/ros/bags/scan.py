"""The data files of a bag, read as far as they can be read: a damaged one up to the damage, and no further.

Facts: https://mcap.dev/spec, and rosbag2_storage_sqlite3's sqlite_storage.cpp (tables `topics` and `messages`, and a newer one
for definitions). Of a damaged MCAP file, chunks whose size or checksum is wrong are left out. Compressed data is unpacked up to
a limit, since a few kilobytes can stand for gigabytes: recordings of robots hardly ever shrink to a hundredth.
"""

from __future__ import annotations

import sqlite3
import struct
import sys
import zlib
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rosbags.interfaces import Qos

BROKEN = (sqlite3.Error, UnicodeError)
"""What reading a spoiled database raises; also SQLite's own complaint may not be readable."""

MAGIC = b"\x89MCAP0\r\n"
FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, STATISTICS = 2, 3, 4, 5, 6, 11
HEAD = struct.Struct("<BQ")
MESSAGE_HEAD = struct.Struct("<HIQQ")
CHUNK_HEAD = struct.Struct("<QQQI")
LARGEST = 1 << 32

MOST_TIMES = 100
"""How many times its size a file may become when its chunks are unpacked."""

ALWAYS = 64 << 20
"""How many bytes it may become in any case."""

COMPUTED = (
    "SELECT 1 FROM sqlite_master AS it LEFT JOIN pragma_table_xinfo(it.name) AS its_column "
    "WHERE (sql NOT LIKE 'CREATE TABLE%' AND sql NOT LIKE 'CREATE INDEX%') OR its_column.hidden"
)
"""Finds views, virtual tables and generated columns, whose rows and values could be without end. rosbag2 makes none."""

Where = tuple[int, ...]
"""Where in a file a message is."""


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
    """What one or several files hold, as far as it can be read.

    Attributes:
        topics: by name and type, for a bag may hold one name with several types, in the order in which they were found.
        entries: the time (ns) of each message, its topic, its file, and where in the file it is.
        expected: how many messages the files themselves say they hold, None where they do not say.
        flaws: a sentence for each thing that is wrong.
    """

    topics: dict[tuple[str, str], BagTopic] = field(default_factory=dict)
    entries: list[tuple[int, BagTopic, DataFile, Where]] = field(default_factory=list)
    expected: int | None = None
    flaws: list[str] = field(default_factory=list)

    def known(self, topic: BagTopic) -> BagTopic:
        """The topic of this name and type that was found first."""
        return self.topics.setdefault((topic.name, topic.type_name), topic)

    def take(self, time: int, topic: BagTopic, file: DataFile, where: Where) -> None:
        """There is one more message."""
        topic.count += 1
        self.entries.append((time, topic, file, where))


class _Spoiled(Exception):
    """A part of the file makes no sense."""


@contextmanager
def scanned(files: list[Path]) -> Iterator[Contents]:
    """What all files of a bag hold, with the messages in the order of their times; the files are open meanwhile."""
    contents = Contents()
    counts: list[int | None] = []
    with ExitStack() as stack:
        for file in files:
            try:
                data_file = DATA_FILES[file.suffix](file, contents)
                stack.callback(data_file.close)
                counts.append(data_file.scan())
            except (OSError, *BROKEN) as error:
                contents.flaws.append(f"{file.name}: it cannot be read ({_told(error)})")
                counts.append(None)
        contents.entries.sort(key=lambda entry: entry[0])
        known = [count for count in counts if count is not None]
        contents.expected = sum(known) if len(known) == len(counts) else None
        yield contents


# A record of MCAP is an opcode (1 byte), a length (8 bytes) and that many bytes. Messages lie in chunks, which may be
# compressed and may have a checksum; behind the last one comes a summary that says again what topics there are.


class McapFile:
    """An MCAP file, whose content is added to `found`."""

    def __init__(self, path: Path, found: Contents) -> None:
        self._name = path.name
        self._size = path.stat().st_size
        self._found = found
        self._file = path.open("rb")
        self.close = self._file.close
        self._chunk_again = lru_cache(8)(lambda place: self._chunk(place, *self._record(place)[1:]))

    def scan(self) -> int | None:
        """Add what the file holds; returns how many messages it says that it has."""
        schemas: dict[int, tuple[str, str]] = {}
        channels: dict[int, BagTopic] = {}
        messages: list[tuple[int, int, Where]] = []
        expected = None
        try:
            for opcode, body, where in self._records():
                if opcode == MESSAGE:
                    number, _, time, _ = MESSAGE_HEAD.unpack_from(body)
                    messages.append((time, number, where))
                elif opcode == SCHEMA:
                    name, at = _text(body, 2)
                    _encoding, at = _text(body, at)
                    schemas[int.from_bytes(body[:2], "little")] = name, _text(body, at)[0]
                elif opcode == CHANNEL:
                    number, schema = struct.unpack_from("<HH", body)
                    type_name, definition = schemas.get(schema, ("", ""))
                    channels.setdefault(number, self._channel(body, type_name, definition))
                elif opcode == STATISTICS:
                    (expected,) = struct.unpack_from("<Q", body)
        except _Spoiled as error:
            self._flaw(str(error))
        except (struct.error, UnicodeDecodeError):
            self._flaw(f"the record before byte {self._file.tell()} is damaged")
        for time, number, where in messages:
            if number in channels:
                self._found.take(time, channels[number], self, where)
        if unknown := sum(number not in channels for _, number, _ in messages):
            self._flaw(f"{unknown} messages belong to a topic whose description is lost")
        return expected

    def read(self, where: Where) -> bytes:
        """The bytes of a message."""
        chunk, begin, end = where
        if chunk:
            return self._chunk_again(chunk)[begin:end]
        self._file.seek(begin)
        return self._file.read(end - begin)

    def _flaw(self, text: str) -> None:
        self._found.flaws.append(f"{self._name}: {text}")

    def _records(self) -> Iterator[tuple[int, memoryview, Where]]:
        """The records of the file, with those in chunks, and where a message's bytes are. Raises _Spoiled at a damage."""
        if self._file.read(len(MAGIC)) != MAGIC:
            raise _Spoiled("it does not begin like an MCAP file")
        place, has_chunks = len(MAGIC), False
        left = max(ALWAYS, MOST_TIMES * self._size)
        while True:
            opcode, length, body = self._record(place)
            begin, whole = place + HEAD.size, len(body) == length
            if opcode == FOOTER and whole:
                if self._file.read() != MAGIC:
                    raise _Spoiled("its end is missing or damaged")
                return
            if opcode == CHUNK:
                has_chunks = True
                records = memoryview(self._chunk(place, length, body, most=left))
                left -= len(records)
                at = 0
                while at + HEAD.size <= len(records):
                    opcode, inner = HEAD.unpack_from(records, at)
                    at += HEAD.size + inner
                    if at <= len(records):
                        yield opcode, records[at - inner : at], (place, at - inner + MESSAGE_HEAD.size, at)
            elif whole and not (opcode == MESSAGE and has_chunks):
                yield opcode, memoryview(body), (0, begin + MESSAGE_HEAD.size, begin + length)
            if not whole:
                raise _Spoiled(f"it ends at byte {self._size}, in the middle of a record")
            place = begin + length

    def _record(self, place: int) -> tuple[int, int, bytes]:
        """Opcode, length and bytes of a record, fewer bytes where the file ends."""
        self._file.seek(place)
        head = self._file.read(HEAD.size)
        if len(head) < HEAD.size:
            raise _Spoiled(f"it ends at byte {self._size}, before its end record")
        opcode, length = HEAD.unpack(head)
        if opcode == 0 or length > LARGEST:
            raise _Spoiled(f"there is no record at byte {place}")
        return opcode, length, self._file.read(length)

    def _chunk(self, place: int, length: int, body: bytes, most: int = LARGEST) -> bytes:
        """The records of the chunk at a place: fewer if it is cut short, none if it is damaged, which becomes a flaw.

        Raises _Spoiled if it would be unpacked to more than `most` bytes.
        """
        _, _, size, checksum = CHUNK_HEAD.unpack_from(body)
        compression, at = _text(memoryview(body), CHUNK_HEAD.size)
        records = body[at + 8 :]
        if compression:
            if size > most:
                why = f"the file would become more than {MOST_TIMES} times as large, which is no usual recording"
                raise _Spoiled(f"the chunk at byte {place} is not unpacked: {why}")
            decompressor = _decompressor(compression)
            try:
                records = bytes(decompressor.decompress(records, size + 1))  # one byte more shows that it lies
            except Exception:
                records = b""  # spoiled
        cut_short = len(records) < size and len(body) < length
        if not cut_short and (len(records) != size or (checksum and zlib.crc32(records) != checksum)):
            self._flaw(
                f"the chunk at byte {place} is damaged (its size or checksum is wrong), so its messages are left out"
            )
            return b""
        return records

    def _channel(self, body: memoryview, type_name: str, definition: str) -> BagTopic:
        """The topic that a channel's record describes, whose metadata is a map of texts."""
        topic, at = _text(body, 4)
        encoding, at = _text(body, at)
        metadata = {}
        end = at + 4 + struct.unpack_from("<I", body, at)[0]
        at += 4
        while at < end:
            key, at = _text(body, at)
            metadata[key], at = _text(body, at)
        offered = metadata.get("offered_qos_profiles", "")
        return self._found.known(BagTopic(topic, type_name, encoding, definition, offered))


def _text(body: memoryview, at: int) -> tuple[str, int]:
    """The text at a byte, where its length is, and the byte behind it."""
    end = at + 4 + struct.unpack_from("<I", body, at)[0]
    if end > len(body):
        raise struct.error
    return bytes(body[at + 4 : end]).decode(), end


class SqliteFile:
    """A database of SQLite, whose content is added to `found`."""

    def __init__(self, path: Path, found: Contents) -> None:
        self._name = path.name
        self._size = path.stat().st_size
        self._found = found
        self._database = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro&immutable=1", uri=True)
        # No value is larger than its file.
        self._database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, max(self._size, 1_000_000))
        self._database.text_factory = lambda raw: raw.decode(errors="replace")
        self.close = self._database.close

    def scan(self) -> None:
        """Add what the file holds; it does not say how many messages there were."""
        for (verdict,) in self._rows("PRAGMA integrity_check(1)"):
            if verdict != "ok":
                self._flaw(verdict.splitlines()[-1])
        for pages, size in self._rows("SELECT page_count, page_size FROM pragma_page_count, pragma_page_size"):
            if pages * size != self._size:
                self._flaw("it is cut short")  # SQLite would take what is missing for zeros
                return
        if self._database.execute(COMPUTED).fetchone():
            self._flaw("its tables are computed, not recorded")
            return
        definitions: dict[str, str] = {}
        with suppress(*BROKEN):  # Humble's has none
            query = "SELECT topic_type, encoded_message_definition FROM message_definitions"
            definitions = dict(self._database.execute(query).fetchall())
        topics: dict[int, BagTopic] = {}
        query = "SELECT rowid, name, type, serialization_format, offered_qos_profiles FROM topics"
        for number, topic, type_name, serialization, offered in self._rows(query):
            definition = definitions.get(type_name, "")
            topics[number] = self._found.known(BagTopic(topic, type_name, serialization, definition, offered))
        last = 0
        for row, number, time in self._rows("SELECT rowid, topic_id, timestamp FROM messages"):
            if row <= last:
                self._flaw("its messages are in no order")  # nor would they ever end
                return
            last = row
            if number in topics and isinstance(time, int):
                self._found.take(time, topics[number], self, (row,))

    def read(self, where: Where) -> bytes:
        """The bytes of a message; none if it has something else."""
        (data,) = self._database.execute("SELECT data FROM messages WHERE rowid = ?", where).fetchone()
        return data if isinstance(data, bytes) else b""

    def _rows(self, query: str) -> Iterator[tuple[Any, ...]]:
        """The rows of a query, up to a damaged one."""
        try:
            yield from self._database.execute(query)
        except BROKEN as error:
            self._flaw(error)

    def _flaw(self, error: object) -> None:
        text = f"{self._name}: the database is damaged ({_told(error)})"
        if text not in self._found.flaws:
            self._found.flaws.append(text)


def _told(error: object) -> str:
    """What is wrong, in one line that can be printed: SQLite quotes what is spoiled."""
    text = str(getattr(error, "strerror", None) or error)
    return "".join(char if char.isprintable() else "?" for char in " ".join(text.split()))


DataFile = McapFile | SqliteFile
DATA_FILES: dict[str, Callable[[Path, Contents], DataFile]] = {".mcap": McapFile, ".db3": SqliteFile}


def _decompressor(compression: str) -> Any:
    """What unpacks a chunk, also one that is cut short."""
    if compression == "lz4":
        from lz4.frame import LZ4FrameDecompressor as Decompressor
    elif compression != "zstd":
        raise _Spoiled(f"its chunks are compressed in an unknown way ({compression[:20]})")
    elif sys.version_info >= (3, 14):
        from compression.zstd import ZstdDecompressor as Decompressor
    else:
        from backports.zstd import ZstdDecompressor as Decompressor
    return Decompressor()
