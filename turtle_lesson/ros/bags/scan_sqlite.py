"""Reading a bag's SQLite file row by row, also one that is cut short or has spoiled pages.

Facts: rosbag2_storage_sqlite3's sqlite_storage.cpp (tables `topics` and `messages`, and newer ones for definitions).
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import closing, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from .contents import Contents, Message, TopicContents, TopicKey

BROKEN = (sqlite3.Error, UnicodeError)
"""What reading a spoiled database raises; also SQLite's own complaint may not be readable."""

FURTHEST = 1 << 40
"""How far, in row numbers, a readable row is looked for behind a spoiled one."""


def scan_sqlite(path: Path, *, keep: bool = False) -> Contents:
    """What the file holds; with `keep` the messages themselves, too."""
    size, missing = _pages(path)
    if not missing:
        return _open_and_scan(path, Contents(), keep)
    found = Contents(flaws=[f"{path.name}: it is cut short"])
    with TemporaryDirectory() as folder:
        whole = (
            Path(folder) / path.name
        )  # without its last page if that is no whole one: it would be filled up with zeros
        whole.write_bytes(path.read_bytes()[:size])
        return _open_and_scan(whole, found, keep)


def _open_and_scan(path: Path, found: Contents, keep: bool) -> Contents:
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


def _pages(path: Path) -> tuple[int, bool]:
    """How many bytes are whole pages, and whether some are missing (https://sqlite.org/fileformat.html, 1.3)."""
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(100)
    page = int.from_bytes(head[16:18], "big")
    page = 65536 if page == 1 else page
    if len(head) < 100 or page < 512:
        return size, False  # no database at all: SQLite will say so
    pages = int.from_bytes(head[28:32], "big") if head[24:28] == head[92:96] else 0
    return size // page * page, size < page * pages


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
    if found.flaws:
        with suppress(*BROKEN):
            database.execute("PRAGMA writable_schema=ON")  # or a file that is too short is not read at all
    topics = _topics(database, name, found)
    data = "data" if keep else "NULL"
    query = f"SELECT id, topic_id, timestamp, {data}, length(data) FROM messages"
    for _, number, time, content, length in _rows(database, query, found):
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


def _rows(database: sqlite3.Connection, query: str, found: Contents) -> Iterator[Any]:
    """All rows that can be read, in the order of their numbers; spoiled ones are jumped over."""
    last, jump = 0, 0
    while jump < FURTHEST:
        try:
            for row in database.execute(f"{query} WHERE id > ? ORDER BY id", (last + jump,)):
                if row[0] <= last:
                    raise sqlite3.DatabaseError("the rows form a cycle")
                last, jump = row[0], 0
                yield row
            return
        except BROKEN:
            if not found.flaws:
                found.flaws.append("the database is damaged in the middle")
            jump = jump * 2 or 1
