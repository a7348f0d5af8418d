"""Reading a bag: what it holds, its messages, and, if it is damaged, how much of it is lost."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import yaml

from .contents import Contents, Message, TopicContents, TopicKey
from .errors import BagError
from .scan_mcap import scan_mcap
from .scan_sqlite import scan_sqlite
from .unpack import TooLargeError, unpack_file, unpack_message

if TYPE_CHECKING:
    from rosbags.interfaces import Qos

SCANNERS = {".mcap": ("mcap", scan_mcap), ".db3": ("sqlite3", scan_sqlite)}
METADATA = "metadata.yaml"
LISTS = ("relative_file_paths", "files", "topics_with_message_count")
"""What is a list in metadata.yaml."""

LONGEST = 10_000_000
DEEPEST = 20
"""How many bytes of metadata.yaml are read, and how deeply its lists and mappings may be nested."""

LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


@dataclass(frozen=True)
class BagTopic:
    """A topic in a bag: name, type, number of messages that can be read, form of the bytes, definition of the type."""

    name: str
    type_name: str
    count: int
    serialization: str
    definition: str
    offered: str

    @property
    def profiles(self) -> list[Qos]:
        """The quality of service that its publishers offered."""
        from rosbags.rosbag2.metadata import parse_qos

        try:
            return parse_qos(self.offered)
        except Exception:
            return []  # a spoiled or foreign description: the default will do


class Bag:
    """A recording on disk; made by `open_bag`. Times are in ns since 1970."""

    def __init__(self, path: Path, files: Sequence[Path], contents: Contents, metadata: dict[str, Any]) -> None:
        self.path = path
        self.files = list(files)
        self.start = contents.start
        self.end = contents.end
        self.message_count = contents.count
        self.size = sum(file.stat().st_size for file in files)
        self.storage = _storage_of(files[0])
        self.topics = [_topic(key, topic) for key, topic in contents.topics.items()]
        self._flaws = contents.flaws
        promised = metadata.get("message_count")
        self._expected = promised if isinstance(promised, int) else contents.expected
        mode = str(metadata.get("compression_mode") or "").lower()
        self.compression = "file" if files[0].suffix == ".zstd" else mode if mode == "message" else ""

    def __repr__(self) -> str:
        damage = ", damaged" if self.damage else ""
        return f"<Bag {self.path.name}: {self.message_count} messages of {len(self.topics)} topics{damage}>"

    @property
    def duration(self) -> int:
        """From the first to the last message, in ns."""
        return 0 if self.start is None or self.end is None else self.end - self.start

    @property
    def lost(self) -> int | None:
        """How many messages cannot be read any more; None where nothing says how many there were."""
        return None if self._expected is None else max(0, self._expected - self.message_count)

    @property
    def damage(self) -> str:
        """What is wrong with the bag, and how much of it can be read, in a sentence; empty for a sound one."""
        if not self._flaws and not self.lost:
            return ""
        reasons = "; ".join(self._flaws[:3]) or f"{METADATA} lists more than the bag contains"
        more = f"; and {len(self._flaws) - 3} more places" if len(self._flaws) > 3 else ""
        return f"the bag is damaged: {reasons}{more}. {self._what_is_left()}"

    def _what_is_left(self) -> str:
        if self.lost is None:
            return f"{self.message_count} messages can be read; how many there were is not known"
        return f"{self.message_count} of {self._expected} messages can be read, {self.lost} are lost"

    def messages(self, topics: Sequence[str] | None = None) -> Iterator[Message]:
        """The messages in the order of their times; only those of some topics, if any are named."""
        every = self._salvaged() if self.damage else self._read()
        for message in every:
            if topics is not None and message.topic not in topics:
                continue
            yield message._replace(data=self._unpacked(message.data)) if self.compression == "message" else message

    def _unpacked(self, data: bytes) -> bytes:
        """A message that was compressed on its own; of a damaged bag, nothing if it is spoiled."""
        try:
            return unpack_message(data)
        except TooLargeError as error:
            reason = str(error)
        except ValueError as error:
            if self.damage:
                return b""
            reason = str(error)
        raise BagError(f"the bag '{self.path}' cannot be read to its end: {reason}")

    def _read(self) -> Iterator[Message]:
        """Read a sound bag message by message, without holding it in memory; rosbags is strict about what is sound."""
        from rosbags.rosbag2 import Reader

        try:
            reader = Reader(self.path)
            reader.open()
            # Messages that are compressed one by one are unpacked here, up to a limit that rosbags does not have.
            reader.storage.metadata = reader.storage.metadata._replace(compression_mode=None)
        except Exception:
            yield from self._salvaged()
            return
        try:
            for connection, time, data in reader.messages(reader.connections):
                yield Message(connection.topic, time, connection.msgtype, bytes(data))
        except Exception as error:
            raise BagError(f"the bag '{self.path}' cannot be read to its end: {error}") from error
        finally:
            reader.close()

    def _salvaged(self) -> Iterator[Message]:
        yield from _scan_all(self.files, keep=True).messages


def open_bag(path: str | Path, *, listed_only: bool = True) -> Bag:
    """Open a bag: its folder, or one of its files; with `listed_only` False all files in the folder are looked at.

    A damaged bag is opened, too: `damage` says what is wrong, and what can be read is read.
    Raises BagError if there is none, or nothing of it can be read.
    """
    path = Path(path).expanduser()
    if not path.exists():
        raise BagError(f"Bag path '{path}' does not exist!")
    metadata, flaws = _read_metadata(path)
    files, missing = _files_of(path, metadata if listed_only else {})
    contents = _scan_all(files, keep=False)
    contents.flaws = [*flaws, *missing, *contents.flaws]
    if not contents.topics and contents.flaws:
        raise BagError(f"nothing of the bag '{path}' can be read: {'; '.join(contents.flaws[:3])}")
    return Bag(path, files, contents, metadata)


def _topic(key: TopicKey, topic: TopicContents) -> BagTopic:
    return BagTopic(key.name, key.type_name, topic.count, topic.serialization, topic.definition, topic.offered)


def _kind(file: Path) -> str:
    """`.mcap` of `run_0.mcap` and of `run_0.mcap.zstd`."""
    return Path(file.stem).suffix if file.suffix == ".zstd" else file.suffix


def _storage_of(file: Path) -> str:
    return SCANNERS[_kind(file)][0]


def _read_metadata(path: Path) -> tuple[dict[str, Any], list[str]]:
    """What metadata.yaml says, and what is wrong with it."""
    if path.is_file():
        return {}, []
    try:
        text = _plain_yaml(path / METADATA)
        found = yaml.load(text, LOADER)["rosbag2_bagfile_information"]
        if not isinstance(found, dict):
            raise ValueError("it is not a mapping")
        wrong = [key for key in LISTS if not isinstance(found.get(key, []), list)]
        return found, [f"{METADATA} is not valid: its {key} is not a list" for key in wrong]
    except TooLargeError as error:
        return {}, [f"{METADATA} cannot be read: {error}"]
    except FileNotFoundError:
        return {}, [f"there is no {METADATA} (was the recording not stopped?)"]
    except Exception as error:
        return {}, [f"{METADATA} cannot be read ({type(error).__name__})"]


def _plain_yaml(file: Path) -> str:
    """The text of metadata.yaml. Raises TooLargeError if it could become far larger than what a recorder writes."""
    if file.is_file() and file.stat().st_size > LONGEST:
        raise TooLargeError(f"it has more than {LONGEST:,} bytes")
    text = file.read_text("utf-8")
    depth = 0
    for event in yaml.parse(text, LOADER):
        depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        if depth > DEEPEST or isinstance(event, yaml.AliasEvent):
            raise TooLargeError("it has aliases, or is nested more deeply than any recorder writes it")
    return text


def _files_of(path: Path, metadata: dict[str, Any]) -> tuple[list[Path], list[str]]:
    """The data files of a bag, and a sentence for each one that is missing."""
    if path.is_file():
        if _kind(path) not in SCANNERS:
            raise BagError(f"'{path}' is not a bag: a bag is a folder with {METADATA}, or an .mcap or .db3 file")
        return [path], []
    named = metadata.get("relative_file_paths")
    named = [path / PurePath(str(name)).name for name in named] if isinstance(named, list) else []
    missing = [f"the file {file.name} is missing" for file in named if not file.is_file()]
    files = [file for file in named if file.is_file() and _kind(file) in SCANNERS]
    files = files or sorted(file for file in path.iterdir() if file.is_file() and _kind(file) in SCANNERS)
    if not files:
        raise BagError(f"'{path}' is not a bag: there is no .mcap or .db3 file in it")
    return files, missing


def _scan_all(files: Sequence[Path], *, keep: bool) -> Contents:
    """Scan all files of a bag."""
    total: Contents | None = None
    for file in files:
        try:
            contents = _scan_one(file, keep=keep)
        except OSError as error:
            contents = Contents(flaws=[f"{file.name}: it cannot be read ({error.strerror or error})"])
        except TooLargeError as error:
            contents = Contents(flaws=[str(error)])
        if total is None:
            total = contents
        else:
            total.add(contents)
    assert total is not None
    return total


def _scan_one(file: Path, *, keep: bool) -> Contents:
    """Scan a file; one that is compressed as a whole is unpacked first."""
    scan = SCANNERS[_kind(file)][1]
    if file.suffix != ".zstd":
        return scan(file, keep=keep)
    with TemporaryDirectory() as folder:
        unpacked = Path(folder) / file.stem
        unpack_file(file, unpacked)
        return scan(unpacked, keep=keep)
