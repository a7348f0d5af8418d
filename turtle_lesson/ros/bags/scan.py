"""Reading the files of a bag as far as they can be read, also one that is cut short or damaged.

Facts: https://mcap.dev/spec, and rosbag2_storage_sqlite3's sqlite_storage.cpp (tables `topics` and `messages`, and newer ones
for definitions). Healthy files are played by `rosbags`; what is found here says whether a file is healthy, and how large it
becomes. A damaged MCAP file is read up to a damaged record, without the chunks whose checksum is wrong; a damaged database up
to a damaged row, and one that is cut short not at all (a recorder that is killed leaves a whole one).
"""

from __future__ import annotations

import os
import sqlite3
import struct
import zlib
from collections.abc import Iterator
from contextlib import closing, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO, NamedTuple

from .unpack import DECOMPRESSORS, limit, too_large, unpack

BROKEN = (sqlite3.Error, UnicodeError)
"""What reading a spoiled database raises; also SQLite's own complaint may not be readable."""

MAGIC = b"\x89MCAP0\r\n"
FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK = 2, 3, 4, 5, 6
CHUNK_INDEX, STATISTICS, DATA_END = 8, 11, 15
FOOTER_SIZE = 9 + 20
TAIL_SIZE = FOOTER_SIZE + len(MAGIC)
HEAD = struct.Struct("<BQ")
MESSAGE_HEAD = struct.Struct("<HIQQ")
CHUNK_HEAD = struct.Struct("<QQQI")
LARGEST = 1 << 32


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


# A record of MCAP is an opcode (1 byte), a length (8 bytes) and that many bytes. Messages lie in chunks, which may be
# compressed and may have a checksum; behind the last one comes a summary that repeats what topics there are and says where
# each chunk is.


class _Spoiled(Exception):
    """A part of the file makes no sense."""


def scan_mcap(path: Path, *, keep: bool = False) -> Contents:
    """What the file holds; with `keep` the messages themselves, too."""
    with path.open("rb") as file:
        return _Scan(file, path.name, os.path.getsize(path), keep).run()


class _Scan:
    """One reading of a file."""

    def __init__(self, file: BinaryIO, name: str, size: int, keep: bool) -> None:
        self._file = file
        self._name = name
        self._size = size
        self._keep = keep
        self._found = Contents()
        self._schemas: dict[int, tuple[str, str]] = {}
        self._channels: dict[int, tuple[int, str, str, str]] = {}
        self._counts: dict[int, int] = {}
        self._messages: list[tuple[int, int, bytes]] = []
        self._chunks: list[int] = []
        self._read: set[int] = set()
        self._left = limit(size)
        self._complete = False
        self._ends_well = False

    def run(self) -> Contents:
        """Read everything that can be read."""
        if self._file.read(len(MAGIC)) != MAGIC:
            self._flaw("it does not begin like an MCAP file")
        self._read_summary()
        place = len(MAGIC)
        while not self._complete:
            try:
                place = self._read_record(place)
            except (_Spoiled, struct.error, UnicodeDecodeError) as error:
                self._flaw(str(error) if isinstance(error, _Spoiled) else f"the record at byte {place} is damaged")
                break
        if self._complete and not self._ends_well:
            self._flaw("its end is missing or damaged")
        if not self._found.flaws and not self._read.issuperset(self._chunks):
            self._flaw("its summary names a chunk that is not there")
        return self._result()

    def _flaw(self, text: str) -> None:
        self._found.flaws.append(f"{self._name}: {text}")

    # -- records -----------------------------------------------------------------------------------------------------

    def _read_record(self, place: int) -> int:
        """Read the record at a place; returns the place of the next one."""
        self._file.seek(place)
        head = self._file.read(HEAD.size)
        if len(head) < HEAD.size:
            raise _Spoiled(f"it ends at byte {self._size}, before its end record")
        opcode, length = HEAD.unpack(head)
        if opcode == 0 or length > LARGEST:
            raise _Spoiled(f"there is no record at byte {place}")
        left = self._size - place - HEAD.size
        if opcode in {DATA_END, FOOTER} and length <= left:
            self._complete = True
            return place
        body = self._file.read(min(length, left))
        if opcode == CHUNK:
            self._read_chunk(body, place, cut_short=length > left)
        elif length <= left:
            self._take(opcode, memoryview(body))
        if length > left:
            raise _Spoiled(f"it ends at byte {self._size}, in the middle of a record")
        return place + HEAD.size + length

    def _take(self, opcode: int, body: memoryview) -> None:
        if opcode == MESSAGE:
            channel, _, time, _ = MESSAGE_HEAD.unpack_from(body)
            self._counts[channel] = self._counts.get(channel, 0) + 1
            self._found.see(time, time)
            if self._keep:
                self._messages.append((time, channel, bytes(body[MESSAGE_HEAD.size :])))
        elif opcode == SCHEMA:
            number = int.from_bytes(body[:2], "little")
            name, _encoding, text = _texts(body, 2, 3)
            self._schemas[number] = name, text
        elif opcode == CHANNEL:
            number, schema = struct.unpack_from("<HH", body)
            topic, encoding = _texts(body, 4, 2)
            self._channels[number] = schema, topic, encoding, _offered(body)

    def _read_chunk(self, body: bytes, place: int, *, cut_short: bool) -> None:
        _, _, size, checksum = CHUNK_HEAD.unpack_from(body)
        (compression,) = _texts(memoryview(body), CHUNK_HEAD.size, 1)
        begin = CHUNK_HEAD.size + 4 + len(compression) + 8
        (packed_size,) = struct.unpack_from("<Q", body, begin - 8)
        if not cut_short and packed_size != len(body) - begin:
            raise _Spoiled(f"the chunk at byte {place} gives a wrong length")
        self._read.add(place)
        records, more = self._unpacked(compression, body[begin:], size, place)
        whole = len(records) == size
        if more or (whole and checksum and zlib.crc32(records) != checksum) or not (whole or cut_short):
            why = "it holds more than it says" if more else "its checksum is wrong"
            self._flaw(f"the chunk at byte {place} is damaged ({why}), so its messages are left out")
            return
        for opcode, record in _records(memoryview(records)):
            self._take(opcode, record)

    def _unpacked(self, compression: str, data: bytes, size: int, place: int) -> tuple[bytes, bool]:
        """The records of a chunk, less if it is cut short, none if it is spoiled; and whether there are more."""
        if compression == "":
            return data[:size], False
        if compression not in DECOMPRESSORS:
            raise _Spoiled(f"its chunks are compressed in an unknown way ({compression[:20]})")
        if size > self._left:
            raise _Spoiled(str(too_large(f"the chunk at byte {place}", self._size)))
        self._left -= size
        return unpack(compression, data, size)

    # -- the summary -------------------------------------------------------------------------------------------------

    def _read_summary(self) -> None:
        """Learn from the end of the file, if it is there, which topics and chunks there are."""
        if self._size < len(MAGIC) + TAIL_SIZE:
            return
        self._file.seek(self._size - TAIL_SIZE)
        tail = self._file.read()
        opcode, length, place = struct.unpack_from("<BQQ", tail)
        self._ends_well = tail[-len(MAGIC) :] == MAGIC and (opcode, length) == (FOOTER, 20)
        if not self._ends_well or not 0 < place < self._size - TAIL_SIZE:
            return
        self._file.seek(place)
        try:
            for kind, body in _records(memoryview(self._file.read(self._size - TAIL_SIZE - place))):
                if kind == CHUNK_INDEX:
                    self._chunks.append(struct.unpack_from("<Q", body, 16)[0])
                elif kind == STATISTICS:
                    self._found.expected = struct.unpack_from("<Q", body)[0]
                elif kind != MESSAGE:
                    self._take(kind, body)
        except (struct.error, UnicodeDecodeError):
            self._flaw("its summary is damaged")

    # -- the result --------------------------------------------------------------------------------------------------

    def _result(self) -> Contents:
        names: dict[int, TopicKey] = {}
        for number, (schema, topic, encoding, offered) in self._channels.items():
            type_name, text = self._schemas.get(schema, ("", ""))
            names[number] = key = TopicKey(topic, type_name)
            self._found.topics.setdefault(key, TopicContents(0, encoding, offered, text))
            self._found.topics[key].count += self._counts.get(number, 0)
        if unknown := sum(count for number, count in self._counts.items() if number not in names):
            self._flaw(f"{unknown} messages belong to a topic whose description is lost")
        self._messages.sort(key=lambda entry: entry[0])
        self._found.messages = [
            Message(names[number].name, time, names[number].type_name, data)
            for time, number, data in self._messages
            if number in names
        ]
        return self._found


def _records(view: memoryview) -> Iterator[tuple[int, memoryview]]:
    """The whole records that follow each other in a part of the file."""
    at = 0
    while at + HEAD.size <= len(view):
        opcode, length = HEAD.unpack_from(view, at)
        at += HEAD.size + length
        if at <= len(view):
            yield opcode, view[at - length : at]


def _texts(body: memoryview, at: int, count: int) -> list[str]:
    """Texts that follow each other from byte `at` on, each with its length before it."""
    found = []
    for _ in range(count):
        (length,) = struct.unpack_from("<I", body, at)
        if at + 4 + length > len(body):
            raise struct.error
        found.append(bytes(body[at + 4 : at + 4 + length]).decode())
        at += 4 + length
    return found


def _offered(body: memoryview) -> str:
    """The profiles in a channel's metadata, which is a map of texts."""
    at = 4
    for text in _texts(body, 4, 2):
        at += 4 + len(text.encode())
    end = at + 4 + struct.unpack_from("<I", body, at)[0]
    at += 4
    while at < end:
        key, value = _texts(body, at, 2)
        if key == "offered_qos_profiles":
            return value
        at += 8 + len(key.encode()) + len(value.encode())
    return ""


def scan_sqlite(path: Path, *, keep: bool = False) -> Contents:
    """What the file holds; with `keep` the messages themselves, too."""
    found = Contents()
    if _is_cut_short(path):
        found.flaws.append(f"{path.name}: it is cut short, and SQLite cannot read it")
        return found
    try:
        database = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro&immutable=1", uri=True)
    except BROKEN as error:
        found.flaws.append(f"{path.name}: it cannot be opened ({_told(error)})")
        return found
    with closing(database):
        database.text_factory = lambda raw: raw.decode(errors="replace")
        size = path.stat().st_size
        database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, max(size, 1_000_000))  # no value is larger than its file
        if _has_views(database):
            found.flaws.append(f"{path.name}: its tables are computed, not recorded, so they are not read")
        else:
            _scan(database, path.name, found, keep, size)
    return found


def _is_cut_short(path: Path) -> bool:
    """Whether pages are missing, which SQLite would take for zeros (https://sqlite.org/fileformat.html, 1.3)."""
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(100)
    page = int.from_bytes(head[16:18], "big")
    page = 65536 if page == 1 else page
    if len(head) < 100 or page < 512:
        return False  # no database at all: SQLite will say so
    pages = int.from_bytes(head[28:32], "big") if head[24:28] == head[92:96] else 0
    return size % page != 0 or size < page * pages


def _has_views(database: sqlite3.Connection) -> bool:
    """Whether something else than plain tables bears the name of a bag's table: its rows could be without end."""
    query = (
        "SELECT 1 FROM sqlite_master WHERE lower(name) IN ('topics', 'messages', 'message_definitions') "
        "AND (type = 'view' OR sql LIKE 'CREATE VIRTUAL%')"
    )
    with suppress(*BROKEN):
        return database.execute(query).fetchone() is not None
    return False  # the file is damaged, and _scan says how


def _scan(database: sqlite3.Connection, name: str, found: Contents, keep: bool, size: int) -> None:
    try:
        verdict = database.execute("PRAGMA integrity_check(1)").fetchone()[0]
        if verdict != "ok":
            found.flaws.append(f"{name}: the database is damaged ({_told(verdict.splitlines()[-1])})")
    except BROKEN as error:
        found.flaws.append(f"{name}: the database is damaged ({_told(error)})")
    topics = _topics(database, name, found)
    data = "data" if keep else "NULL"
    query = f"SELECT id, topic_id, timestamp, {data}, length(data) FROM messages"
    last = 0
    try:
        for row, number, time, content, length in database.execute(f"{query} ORDER BY id"):
            if row <= last:
                raise sqlite3.DatabaseError("the rows form a cycle")
            last = row
            size -= length if isinstance(length, int) else 0
            if size < 0:
                found.flaws.append(f"{name}: its messages are computed, not recorded: they are larger than the file")
                break
            key = topics.get(number)
            if key is None or not isinstance(time, int):
                continue
            found.topics[key].count += 1
            found.see(time, time)
            if keep:
                found.messages.append(Message(key.name, time, key.type_name, content))
    except BROKEN:
        if not found.flaws:
            found.flaws.append(f"{name}: the database is damaged in the middle")
    found.messages.sort(key=lambda message: message.time)
    if not found.flaws:
        found.expected = found.count


def _topics(database: sqlite3.Connection, name: str, found: Contents) -> dict[int, TopicKey]:
    definitions: dict[str, str] = {}
    with suppress(*BROKEN):
        query = "SELECT topic_type, encoded_message_definition FROM message_definitions"
        definitions = dict(database.execute(query).fetchall())
    topics: dict[int, TopicKey] = {}
    try:
        query = "SELECT id, name, type, serialization_format, offered_qos_profiles FROM topics"
        for number, topic, type_name, serialization, offered in database.execute(query):
            topics[number] = key = TopicKey(topic, type_name)
            found.topics[key] = TopicContents(0, serialization, offered, definitions.get(type_name, ""))
    except BROKEN as error:
        found.flaws.append(f"{name}: its topics cannot be read ({_told(error)})")
    return topics


def _told(error: object) -> str:
    """What SQLite says, in one line that can be printed: it quotes what is spoiled."""
    return "".join(char if char.isprintable() else "?" for char in " ".join(str(error).split()))
