"""What has been heard of a turtle, as tables of numbers: the plots read them, the recorder fills them."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Mapping
from functools import cached_property
from numbers import Real
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from ..turtlesim.obstacles import Obstacle

if TYPE_CHECKING:
    import numpy as np

    from .widgets.goal_client import Goal

WORLD = 11.088889
"""Side of turtlesim's square world in metres: 499 pixels at its 45 pixels a metre."""

Listener = Callable[[Any, Mapping[str, Any]], None]
"""What hears a message and rclpy's information about it (`source_timestamp` in ns, …)."""

LIMIT = 200_000
"""How many rows a table keeps unless told otherwise: more than 53 minutes of a turtle's pose."""


class Table:
    """Rows of one time stamp (ns) and a few numbers; of all rows the newest `limit` are kept.

    A row is packed into 8 bytes for each of its numbers. Beside five appends to five columns, packing takes
    two thirds of the time, and this is done 62.5 times for each second of robot time.
    """

    def __init__(self, *names: str, limit: int = LIMIT) -> None:
        self.names = names
        self.limit = limit
        self._row = struct.Struct(f"=q{len(names)}d")
        self._rows = bytearray()
        # bytes at which old rows go: some way over the limit, so that it is not done for each row
        self._full = (limit + limit // 8 + 1) * self._row.size

    def __len__(self) -> int:
        return min(len(self._rows) // self._row.size, self.limit)

    def append(self, stamp: int, *values: float) -> None:
        """Add a row: the time in ns, then one number for each name."""
        self._rows += self._row.pack(stamp, *values)
        self._trim()

    def listener(self, *paths: str) -> Listener:
        """Return a subscription callback that adds a row for each message.

        `paths` says where in the message the numbers are, such as `x` or `linear.x`, in the order of `names`;
        a path "" stands for a number that the message does not have.
        """
        read = _reader(paths or self.names)
        rows, pack, add = self._rows, self._row.pack, self._rows.extend
        full = self._full

        def hear(message: Any, info: Mapping[str, Any]) -> None:
            add(pack(info["source_timestamp"], *read(message)))
            if len(rows) > full:
                self._trim()

        return hear

    def array(self) -> np.ndarray:
        """The rows as a numpy array of their own: fields `stamp` (ns, int64) and `names` (float64)."""
        return self.newest(self.limit)

    def newest(self, count: int) -> np.ndarray:
        """The last `count` rows, or all where there are fewer: cheap however long the table is."""
        import numpy as np

        wanted = min(count, len(self)) * self._row.size
        return np.frombuffer(bytes(self._rows[len(self._rows) - wanted :]), self._type)

    def last(self) -> tuple[float, ...]:
        """The newest row: its time (ns) and its numbers; () where there is none."""
        at = len(self._rows) - self._row.size
        return self._row.unpack_from(self._rows, at) if at >= 0 else ()

    def after(self, stamp: int) -> np.ndarray:
        """The rows that are newer than `stamp` (ns): cheap where they are few, however long the table is."""
        count = 16
        while True:
            rows = self.newest(count)
            if len(rows) < count or rows["stamp"][0] <= stamp:
                return rows[rows["stamp"] > stamp]
            count *= 4

    @cached_property
    def _type(self) -> np.dtype[Any]:
        import numpy as np

        return np.dtype([("stamp", "=i8"), *((name, "=f8") for name in self.names)])

    def _trim(self) -> None:
        if len(self._rows) > self._full:
            del self._rows[: -self.limit * self._row.size]


def _reader(paths: tuple[str, ...]) -> Callable[[Any], tuple[float, ...]]:
    """A function from a message to its numbers; `attrgetter` alone is fastest, for two numbers and more."""
    if all(paths) and len(paths) > 1:
        return attrgetter(*paths)
    readers = [attrgetter(path) if path else lambda message: math.nan for path in paths]
    return lambda message: tuple(read(message) for read in readers)


NANOSECONDS = 1_000_000_000

POSE_TOPIC = "/turtle1/pose"
COMMAND_TOPIC = "/turtle1/cmd_vel"
STATUS_TOPIC = "/robot/status"
STATUS_TYPE = "robot_controller/msg/TurtleStatus"
SCAN_TOPIC = "/obstacles"
OBSTACLE_TOPIC = "/world/obstacles"

UNDER_WAY = 1_000_000
"""Nanoseconds that a message takes at most here. A pose sent later than this before a scan was not known to its scanner."""


class Recording:
    """The newest messages about turtle1, in the order in which they came.

    `origin` (ns) is the moment that plots call 0 s. `last_scan` is the newest
    sensor_msgs/msg/LaserScan, `obstacles` what stands in the world now, `goals` what widgets have sent, the oldest first.
    """

    def __init__(self, *, origin: int = 0) -> None:
        self.origin = origin
        self.poses = Table("x", "y", "theta", "speed")
        self.commands = Table("forward", "sideways", "turn")
        self.statuses = Table("x", "y", "theta", "vel_x", "vel_y", "battery")
        self.scans = Table()
        self.worlds = Table()
        self.last_scan: Any = None
        self.obstacles: dict[tuple[str, int], Obstacle] = {}
        self.goals: list[Goal] = []

    def pose(self, until: int | None = None) -> tuple[float, float, float] | None:
        """The newest pose, x, y (m) and theta (rad), of those not later than `until` (ns); None where none was heard."""
        row = self.poses.last()
        if until is not None:
            rows = self.poses.newest(256)
            rows = rows[rows["stamp"] <= until]
            row = rows[-1].item() if len(rows) else ()
        if not row or not all(map(math.isfinite, row[1:4])):
            return None
        return row[1], row[2], row[3]

    def pose_at_scan(self) -> tuple[float, float, float] | None:
        """Where the turtle was at the newest scan, as its scanner knew it; None where no scan or no such pose was heard."""
        if self.last_scan is None:
            return None
        return self.pose(until=int(self.scans.last()[0]) - UNDER_WAY)

    def seconds(self, stamps: Any) -> Any:
        """Times in ns (a number or an array) as seconds since `origin`."""
        return (stamps - self.origin) / NANOSECONDS

    def why_silent(self, topic: str) -> str:
        """A sentence on why nothing was heard on a topic, and what to try."""
        return f"No message has come on {topic} yet. Let robot time pass: lesson.run(1.0)."


def nanoseconds(name: str, seconds: Any) -> int:
    """Return a time in ns that was given in s, as `name`. Raises ValueError for what is no time."""
    if isinstance(seconds, bool) or not isinstance(seconds, Real) or not math.isfinite(seconds):
        raise ValueError(f"{name} must be a time in seconds since the lesson's start, got {seconds!r}: try {name}=10.0")
    return round(float(seconds) * NANOSECONDS)
