"""What `ros2 bag info` prints.

Facts: rosbag2_py's format_bag_meta_data.cpp. Of it, Humble cuts times to milliseconds without leading zeros, so that
12.005 s becomes `12.5s`; here they are whole, with nine digits, as Jazzy prints them. Days and hours are UTC, the same
on every machine.
"""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING

from ..core import NANOSECONDS

if TYPE_CHECKING:
    from .bag import Bag

INDENT = 19
UNITS = ("B", "KiB", "MiB", "GiB", "TiB")
MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")


def info_text(bag: Bag) -> str:
    """The description of a bag, beginning with an empty line."""
    start, end = bag.start or 0, bag.end or 0
    rows = [
        ("Files", f"\n{'':{INDENT}}".join(file.name for file in bag.files)),
        ("Bag size", size_text(bag.size)),
        ("Storage id", bag.storage),
        ("Duration", f"{seconds_text(bag.duration)}s"),
        ("Start", moment_text(start)),
        ("End", moment_text(end)),
        ("Messages", str(bag.message_count)),
        ("Topic information", _topics(bag)),
    ]
    return "\n".join(["", *(f"{name + ':':{INDENT}}{value}" for name, value in rows), ""])


def _topics(bag: Bag) -> str:
    lines = [
        f"Topic: {topic.name} | Type: {topic.type_name} | Count: {topic.count} | "
        f"Serialization Format: {topic.serialization}"
        for topic in bag.topics
    ]
    return f"\n{'':{INDENT}}".join(lines)


def size_text(size: int) -> str:
    """A number of bytes: `512 B`, `4.0 KiB`."""
    amount, unit = float(size), 0
    while amount >= 1024 and unit < len(UNITS) - 1:
        amount, unit = amount / 1024, unit + 1
    return f"{amount:.{min(unit, 1)}f} {UNITS[unit]}"


def seconds_text(nanoseconds: int) -> str:
    """Seconds with all nine digits behind the point."""
    return f"{nanoseconds // NANOSECONDS}.{nanoseconds % NANOSECONDS:09d}"


def moment_text(nanoseconds: int) -> str:
    """A moment since 1970: `Jan 15 2027 08:00:00.000000000 (1800000000.000000000)`."""
    moment = datetime.fromtimestamp(nanoseconds // NANOSECONDS, UTC)
    day = f"{MONTHS[moment.month - 1]} {moment.day:2d} {moment.year}"
    return f"{day} {moment:%H:%M:%S}.{nanoseconds % NANOSECONDS:09d} ({seconds_text(nanoseconds)})"
