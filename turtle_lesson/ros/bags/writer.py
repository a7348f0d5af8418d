"""Writing a bag: a new folder with metadata.yaml and one data file, as `ros2 bag record` makes it.

`rosbags` writes the bytes (format version 8: Humble and all later releases read it, and Humble cannot read 9, in which
rosbag2_storage's yaml.hpp makes lists of the offered profiles). Added to it here: the real name of the file
(`run_0.mcap`), the hash of each topic's type in an MCAP file (rosbag2_storage_mcap's `topic_type_hash`), and checksums,
without which damage cannot be noticed.

A schema is a message's definition and all that it is made of. Facts: rosbag2_cpp's
message_definitions/local_message_definition_source.cpp and https://mcap.dev/spec/registry (encoding `ros2msg`): the definition
itself, then for each other message a line of 80 `=`, a line `MSG: package/Name` and its definition. The hash is that of REP
2011, version 1 (RIHS01).
"""

from __future__ import annotations

import os
import sqlite3
import weakref
import zlib
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from ..runtime import files
from ..sim.simulation import NANOSECONDS
from . import BagError, UnrecordableType

if TYPE_CHECKING:
    from rosbags.interfaces import Connection, Qos

STORAGES = ("mcap", "sqlite3")

CHUNK_SIZE = 1 << 16
"""After how many bytes a chunk is closed and written out: so much at most is lost by a crash or by a spoiled byte."""

CHUNK_CHECKSUM = 1 + 8 + 3 * 8
"""Where, in a chunk's record, its checksum stands: after opcode, length, two times and the size."""

SEPARATOR = "=" * 80


class BagWriter:
    """A bag that is being written. Times are in ns since 1970.

    Raises BagError where there is something of that name already (nothing is ever overwritten), or for an unknown storage.
    """

    def __init__(self, folder: Path, storage: str = "mcap") -> None:
        if storage not in STORAGES:
            raise BagError(f"a bag is stored as {' or '.join(STORAGES)}, got {storage!r}")
        if os.path.lexists(folder):
            raise BagError(f"Output folder '{folder}' already exists.")
        self.count = 0
        self._connections: dict[tuple[str, str], Any] = {}
        self._writer = _open(folder, storage)
        files.in_use.add(folder.resolve())
        # Also when Python ends before anybody said stop.
        self._end = weakref.finalize(self, _close, self._writer, folder.resolve())

    @property
    def closed(self) -> bool:
        """Whether the bag is complete."""
        return not self._end.alive

    def add_topic(self, topic: str, message_class: Any, offered: Sequence[QoSProfile]) -> None:
        """Make a topic known, with its publishers' profiles. Raises UnrecordableType for a type that no bag can hold."""
        text = schema_text(message_class)
        self._connections[topic, message_class._TYPE_NAME] = self._writer.add_connection(
            topic,
            message_class._TYPE_NAME,
            msgdef=text,
            rihs01=type_hash(message_class, text),
            offered_qos_profiles=[as_recorded(profile) for profile in offered],
        )

    def write(self, topic: str, type_name: str, time: int, data: bytes) -> None:
        """Put in a message of a known topic, as CDR bytes."""
        self._writer.write(self._connections[topic, type_name], time, data)
        self.count += 1

    def close(self) -> None:
        """Complete the bag. A second call does nothing."""
        self._end()


def _open(folder: Path, storage: str) -> Any:
    """A writer of rosbags, opened: the folder is there now."""
    from rosbags.rosbag2 import StoragePlugin, Writer, WriterError
    from rosbags.rosbag2.storage_mcap import McapWriter, write_channel, write_string
    from rosbags.rosbag2.storage_sqlite3 import Sqlite3Writer

    class CheckedMcapWriter(McapWriter):
        """Writes smaller chunks, each with its checksum, and the hash of each topic's type: McapWriter leaves them out."""

        def add_connection(self, connection: Connection, offered_qos_profiles: str) -> None:
            place = self.chunk.bio.tell()
            super().add_connection(connection, offered_qos_profiles)
            channel, noted = self.channels.pop(), BytesIO()
            write_string(noted, "topic_type_hash")
            write_string(noted, connection.digest)
            self.channels.append(channel._replace(metadata=channel.metadata + noted.getvalue()))
            self.chunk.bio.seek(place)  # what was written there is shorter
            write_channel(self.chunk.bio, self.channels[-1], self.schemas)

        def close_chunk(self) -> None:
            start, checksum = self.bio.tell(), zlib.crc32(self.chunk.bio.getvalue())
            super().close_chunk()
            end = self.bio.tell()
            self.bio.seek(start + CHUNK_CHECKSUM)
            self.bio.write(checksum.to_bytes(4, "little"))
            self.bio.seek(end)
            self.bio.flush()

        def write(self, connection: Connection, timestamp: int, data: bytes | memoryview) -> None:
            super().write(connection, timestamp, data)
            if self.chunk.bio.tell() > CHUNK_SIZE:
                self.close_chunk()

    class ExactSqlite3Writer(Sqlite3Writer):
        """Writes the file of this name: Sqlite3Writer makes a URI of it, in which %, ? and # mean something else."""

        def __init__(self, path: Path, _compression: object) -> None:
            self.path = path / f"{path.name}.db3"
            self.conn = sqlite3.connect(self.path)
            self.conn.executescript(self.SQLITE_SCHEMA)
            self.cursor = self.conn.cursor()

    plugin = StoragePlugin[storage.upper()]
    make: Any = CheckedMcapWriter if plugin is StoragePlugin.MCAP else ExactSqlite3Writer
    try:
        writer = Writer(folder, version=8, storage_plugin=plugin)
        writer.STORAGE_PLUGINS = {plugin: lambda path, mode: make(_Numbered(path), mode)}  # type: ignore[dict-item]
        writer.open()
    except (WriterError, OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error  # without the name once more
        raise BagError(f"the bag {str(folder)[:80]} cannot be written: {why}") from None
    return writer


class _Numbered:
    """A folder whose first file is `name_0`: rosbags calls a data file like its folder."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.name = f"{folder.name}_0"

    def __truediv__(self, name: str) -> Path:
        return self._folder / name


def _close(writer: Any, folder: Path) -> None:
    files.in_use.discard(folder)
    writer.close()


def schema_text(message_class: Any) -> str:
    """The `ros2msg` text of a message class: its definition with those of its fields' messages."""
    parts: dict[str, str] = {}

    def add_parts_of(whole: Any) -> None:
        for part in [kind.element_class for kind in whole._KINDS]:
            if part is not None and part._TYPE_NAME not in parts:
                package, _, base = part._TYPE_NAME.split("/")
                parts[part._TYPE_NAME] = f"MSG: {package}/{base}\n{_own_text(part)}"
                add_parts_of(part)

    add_parts_of(message_class)
    return f"{SEPARATOR}\n".join([_own_text(message_class), *parts.values()])


def type_hash(message_class: Any, text: str) -> str:
    """The RIHS01 hash of a message whose schema text is `text`.

    Raises UnrecordableType for what no bag's reader understands, such as a wstring.
    """
    from rosbags.typesys import get_types_from_msg
    from rosbags.typesys.store import Typestore

    name = message_class._TYPE_NAME
    try:
        store = Typestore()
        store.register(get_types_from_msg(text, name))
        return str(store.hash_rihs01(name))
    except Exception as error:
        wide = " (it has a wstring)" if "wstring" in text else ""
        raise UnrecordableType(f"messages of type {name} cannot be recorded{wide}: {error}") from error


def _own_text(message_class: Any) -> str:
    """The definition as its author wrote it; the rules of definitions keep separator lines out of it."""
    text: str = message_class._DEFINITION.text.replace("\r\n", "\n")
    return text if text.endswith("\n") or not text else f"{text}\n"


def as_recorded(profile: QoSProfile) -> Qos:
    """A publisher's profile as a bag holds it, with what it left open filled in."""
    from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime

    used = profile._as_used()
    times = (used.deadline, used.lifespan, used.liveliness_lease_duration)
    deadline, lifespan, lease = (QosTime(*divmod(time.nanoseconds, NANOSECONDS)) for time in times)
    return Qos(
        QosHistory(used.history),
        profile.depth,
        QosReliability(used.reliability),
        QosDurability(used.durability),
        deadline,
        lifespan,
        QosLiveliness(used.liveliness),
        lease,
        profile.avoid_ros_namespace_conventions,
    )


def profile_of(*, reliable: bool, latched: bool, keep_all: bool, depth: int = 0) -> QoSProfile:
    """The profile with which messages are recorded or played."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL if keep_all else HistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )
