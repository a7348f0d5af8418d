"""A table of numbers that grows by a row a message: small in memory, and cheap to add to."""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from operator import attrgetter
from typing import Any

import numpy as np

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
        self._type = np.dtype([("stamp", "=i8"), *((name, "=f8") for name in names)])

    def __len__(self) -> int:
        return min(len(self._rows) // self._row.size, self.limit)

    def __repr__(self) -> str:
        return f"<Table of {', '.join(('stamp', *self.names))}: {len(self)} rows>"

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
        return np.frombuffer(bytes(self._rows[-self.limit * self._row.size :]), self._type)

    def newest(self, count: int) -> np.ndarray:
        """The last `count` rows, or all where there are fewer: cheap however long the table is."""
        wanted = min(count, len(self)) * self._row.size
        return np.frombuffer(bytes(self._rows[len(self._rows) - wanted :]), self._type)

    @property
    def _full(self) -> int:
        """Bytes at which old rows go: some way over the limit, so that it is not done for each row."""
        return (self.limit + self.limit // 8 + 1) * self._row.size

    def _trim(self) -> None:
        if len(self._rows) > self._full:
            del self._rows[: -self.limit * self._row.size]


def _reader(paths: tuple[str, ...]) -> Callable[[Any], tuple[float, ...]]:
    """A function from a message to its numbers; `attrgetter` alone is fastest, for two numbers and more."""
    if all(paths) and len(paths) > 1:
        return attrgetter(*paths)
    readers = [attrgetter(path) if path else _missing for path in paths]
    return lambda message: tuple(read(message) for read in readers)


def _missing(message: Any) -> float:
    return float("nan")
