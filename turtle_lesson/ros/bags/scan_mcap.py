"""Reading an MCAP file record by record, also one that is cut short or has spoiled parts.

Facts: https://mcap.dev/spec. A record is an opcode (1 byte), a length (8 bytes) and that many bytes. Messages lie in
chunks, which may be compressed and may have a checksum; behind the last one comes a summary that repeats what topics
there are and says where each chunk is. Healthy files are played by `rosbags`; it gives up where this one goes on.
"""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from .contents import Contents, Message, TopicContents, TopicKey
from .unpack import DECOMPRESSORS, limit, too_large, unpack

MAGIC = b"\x89MCAP0\r\n"
FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, CHUNK_INDEX, STATISTICS, DATA_END = (
    0x02,
    0x03,
    0x04,
    0x05,
    0x06,
    0x08,
    0x0B,
    0x0F,
)
FOOTER_SIZE = 9 + 20
TAIL_SIZE = FOOTER_SIZE + len(MAGIC)
HEAD = struct.Struct("<BQ")
MESSAGE_HEAD = struct.Struct("<HIQQ")
CHUNK_HEAD = struct.Struct("<QQQI")
LARGEST = 1 << 32


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
                following = [chunk for chunk in self._chunks if chunk > place]
                self._flaw(str(error) if isinstance(error, _Spoiled) else f"the record at byte {place} is damaged")
                if not following:
                    break
                place = following[0]
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
            self._flaw(f"the chunk at byte {place} gives a wrong length")  # its checksum tells whether that is all
        self._read.add(place)
        records, more = self._unpacked(compression, body[begin:], size, place)
        whole = len(records) == size  # also where only the record's length is spoiled, so that it seems cut short
        if more or (whole and checksum and zlib.crc32(records) != checksum) or not (whole or cut_short):
            why = "it holds more than it says" if more else "its checksum is wrong"
            self._flaw(f"the chunk at byte {place} is damaged ({why}), so its messages are left out")
            return
        view, at = memoryview(records), 0
        while at + HEAD.size <= len(records):
            opcode, length = HEAD.unpack_from(records, at)
            at += HEAD.size + length
            if at <= len(records):
                self._take(opcode, view[at - length : at])

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
        self._chunks = sorted(place for place in self._chunks if place < self._size)

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
    at = 0
    while at + HEAD.size <= len(view):
        opcode, length = HEAD.unpack_from(view, at)
        at += HEAD.size + length
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
