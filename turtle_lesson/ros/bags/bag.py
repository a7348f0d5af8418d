"""Reading a bag: what it holds, its messages, how much of a damaged one is lost, `ros2 bag info`.

Facts: rosbag2_py's format_bag_meta_data.cpp (info) and rosbag2_storage's yaml.hpp (metadata.yaml).
"""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path, PurePath
from typing import Any, NamedTuple

from ..runtime.bounded_yaml import LONGEST, safe_load
from ..sim.simulation import NANOSECONDS
from . import BagError
from .scan import Contents, contents_of

STORAGES = {".mcap": "mcap", ".db3": "sqlite3"}
METADATA = "metadata.yaml"

INDENT = 19
UNITS = ("B", "KiB", "MiB", "GiB", "TiB")


class Message(NamedTuple):
    """One recorded message: its topic, its time (ns since 1970), its type, and its CDR bytes."""

    topic: str
    time: int
    type_name: str
    data: bytes


class Bag:
    """A recording on disk; made by `open_bag`. Times are in ns since 1970, and 0 where there is no message."""

    def __init__(self, path: Path, files: list[Path], contents: Contents, metadata: dict[str, Any]) -> None:
        self._messages = messages = contents.messages
        self.path = path
        self.files = files
        self.start, self.end = (messages[0][0], messages[-1][0]) if messages else (0, 0)
        self.duration = self.end - self.start
        self.message_count = len(messages)
        self.size = sum(file.stat().st_size for file in files)
        self.storage = STORAGES[files[0].suffix]
        self.topics = list(contents.topics.values())
        self._flaws = contents.flaws
        promised = metadata.get("message_count")
        self._expected = promised if isinstance(promised, int) else None

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
        left = f"{self.message_count} of {self._expected} messages can be read, {self.lost} are lost"
        if self.lost is None:
            left = f"{self.message_count} messages can be read; how many there were is not known"
        return f"the bag is damaged: {reasons}{more}. {left}"

    def messages(self) -> Iterator[Message]:
        """The messages in the order of their times."""
        for time, topic, data in self._messages:
            yield Message(topic.name, time, topic.type_name, bytes(data))


def open_bag(path: str | Path) -> Bag:
    """Open a bag: its folder, or one of its files.

    A damaged bag is opened, too: `damage` says what is wrong, and what can be read is read.
    Raises BagError if there is none, or nothing of it can be read.
    """
    path = Path(path).expanduser()
    if not path.exists():
        raise BagError(f"Bag path '{path}' does not exist!")
    metadata, flaws = _read_metadata(path)
    files, missing = _files_of(path, metadata)
    contents = contents_of(files)
    contents.flaws = [*flaws, *missing, *contents.flaws]
    if not contents.topics and contents.flaws:
        raise BagError(f"nothing of the bag '{path}' can be read: {'; '.join(contents.flaws[:3])}")
    return Bag(path, files, contents, metadata)


def _read_metadata(path: Path) -> tuple[dict[str, Any], list[str]]:
    """What metadata.yaml says, and what is wrong with it."""
    file = path / METADATA
    if path.is_file():
        return {}, []
    try:
        with file.open(encoding="utf-8") as stream:
            found = safe_load(stream.read(LONGEST + 1))["rosbag2_bagfile_information"]
        return dict(found.items()), []
    except FileNotFoundError:
        return {}, [f"there is no {METADATA} (was the recording not stopped?)"]
    except Exception as error:
        return {}, [f"{METADATA} cannot be read ({getattr(error, 'problem', None) or type(error).__name__})"]


def _files_of(path: Path, metadata: dict[str, Any]) -> tuple[list[Path], list[str]]:
    """The data files of a bag, and a sentence for each one that is missing."""
    named = metadata.get("relative_file_paths")
    named = [path / PurePath(str(name)).name for name in named] if isinstance(named, list) else []
    missing = [f"the file {file.name} is missing" for file in named if not file.is_file()]
    files = [path] if path.is_file() else sorted(path.iterdir())
    mode = str(metadata.get("compression_mode") or "none").lower()
    if mode != "none" or any(file.suffix == ".zstd" for file in files):
        raise BagError(
            f"the bag '{path}' was recorded with --compression-mode, which is not read here: record it without, or convert "
            "it with `ros2 bag convert` on a real ROS 2"
        )
    for some in (named, files):
        if found := [file for file in some if file.is_file() and file.suffix in STORAGES]:
            return found, missing
    if path.is_file():
        raise BagError(f"'{path}' is not a bag: a bag is a folder with {METADATA}, or an .mcap or .db3 file")
    raise BagError(f"'{path}' is not a bag: there is no .mcap or .db3 file in it")


def info_text(bag: Bag) -> str:
    """What `ros2 bag info` prints: the description of a bag, beginning with an empty line.

    Humble cuts times to milliseconds without leading zeros, so that 12.005 s becomes `12.5s`; here they are whole, with nine
    digits, as Jazzy prints them. Days and hours are UTC, the same on every machine.
    """
    topics = [
        f"Topic: {topic.name} | Type: {topic.type_name} | Count: {topic.count} | "
        f"Serialization Format: {topic.serialization}"
        for topic in bag.topics
    ]
    rows = [
        ("Files", f"\n{'':{INDENT}}".join(file.name for file in bag.files)),
        ("Bag size", size_text(bag.size)),
        ("Storage id", bag.storage),
        ("Duration", f"{seconds_text(bag.duration)}s"),
        ("Start", moment_text(bag.start)),
        ("End", moment_text(bag.end)),
        ("Messages", str(bag.message_count)),
        ("Topic information", f"\n{'':{INDENT}}".join(topics)),
    ]
    return "\n".join(["", *(f"{name + ':':{INDENT}}{value}" for name, value in rows), ""])


def size_text(size: int) -> str:
    """A number of bytes: `512 B`, `4.0 KiB`."""
    unit = min((size.bit_length() - 1) // 10, len(UNITS) - 1) if size else 0
    return f"{size / 1024**unit:.{min(unit, 1)}f} {UNITS[unit]}"


def seconds_text(nanoseconds: int) -> str:
    """Seconds with all nine digits behind the point."""
    return f"{nanoseconds // NANOSECONDS}.{nanoseconds % NANOSECONDS:09d}"


def moment_text(nanoseconds: int) -> str:
    """A moment since 1970: `Jan 15 2027 08:00:00.000000000 (1800000000.000000000)`."""
    moment = datetime.fromtimestamp(nanoseconds // NANOSECONDS, UTC)
    day = f"{moment.ctime()[4:10]} {moment.year}"  # English, whatever the locale
    return f"{day} {moment:%H:%M:%S}.{nanoseconds % NANOSECONDS:09d} ({seconds_text(nanoseconds)})"
