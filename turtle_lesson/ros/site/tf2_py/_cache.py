"""What is kept of one frame: its transforms of the last seconds, or the one of a frame that never moves.

Facts: geometry2, tf2/src/cache.cpp and static_cache.cpp. Times are in ns; 0 means "the latest".
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from typing import NamedTuple

from ._rotation import Quaternion, Vector, lerp, slerp


class Kept(NamedTuple):
    """One transform: where a frame is, seen from its parent, at a time (ns)."""

    stamp: int
    parent: str
    turn: Quaternion
    place: Vector


class Unreachable(Exception):
    """No transform at the time that was asked for; the text says why, and may be empty."""


def shown_time(stamp: int) -> str:
    """A time (ns) as tf2's messages show it: seconds with six decimals."""
    return f"{stamp / 1e9:.6f}"


class TimeCache:
    """The transforms of a frame that moves, as long as `span` (ns) back from the latest."""

    is_static = False

    def __init__(self, span: int) -> None:
        self._span = span
        self._stamps: list[int] = []
        self._kept: list[Kept] = []

    def __len__(self) -> int:
        return len(self._kept)

    def insert(self, new: Kept) -> bool:
        """Keep one more; False if it is older than what is kept."""
        latest = self.latest_stamp()
        self._prune(latest)
        if self._kept and new.stamp < latest - self._span:
            return False
        end = bisect_right(self._stamps, new.stamp)
        if new not in self._kept[bisect_left(self._stamps, new.stamp) : end]:
            self._stamps.insert(end, new.stamp)
            self._kept.insert(end, new)
        return True

    def _prune(self, latest: int) -> None:
        old = bisect_left(self._stamps, latest - self._span)
        if old:
            del self._stamps[:old], self._kept[:old]

    def clear(self) -> None:
        """Forget everything."""
        self._stamps.clear()
        self._kept.clear()

    def latest_stamp(self) -> int:
        """The time of the latest; 0 if there is none."""
        return self._stamps[-1] if self._stamps else 0

    def oldest_stamp(self) -> int:
        """The time of the oldest; 0 if there is none."""
        return self._stamps[0] if self._stamps else 0

    def latest_parent(self) -> str | None:
        """The parent in the latest; None if there is none."""
        return self._kept[-1].parent if self._kept else None

    def parent_at(self, time: int) -> str:
        """The parent at a time. Raises Unreachable."""
        return self._around(time)[0].parent

    def at(self, time: int) -> Kept:
        """The transform at a time, between two kept ones if need be. Raises Unreachable."""
        one, two = self._around(time)
        if two is None or one.parent != two.parent:
            return one
        share = (time - one.stamp) / (two.stamp - one.stamp)
        return Kept(one.stamp, one.parent, slerp(one.turn, two.turn, share), lerp(one.place, two.place, share))

    def _around(self, time: int) -> tuple[Kept, Kept | None]:
        """The one right before a time, and the one after; None where the first is of just this time."""
        if not self._kept:
            raise Unreachable("")
        if time in (0, self._stamps[-1]):
            return self._kept[-1], None
        if time == self._stamps[0]:
            return self._kept[0], None
        self._check_reaches(time)
        after = bisect_right(self._stamps, time)
        one = self._kept[after - 1]
        return one, None if one.stamp == time else self._kept[after]

    def _check_reaches(self, time: int) -> None:
        wanted, oldest, latest = shown_time(time), self._stamps[0], self._stamps[-1]
        if len(self._kept) == 1:
            only = f"but only time {shown_time(latest)} is in the buffer"
            raise Unreachable(f"Lookup would require extrapolation at time {wanted}, {only}")
        if time > latest:
            known = f"Requested time {wanted} but the latest data is at time {shown_time(latest)}"
            raise Unreachable(f"Lookup would require extrapolation into the future.  {known}")
        if time < oldest:
            known = f"Requested time {wanted} but the earliest data is at time {shown_time(oldest)}"
            raise Unreachable(f"Lookup would require extrapolation into the past.  {known}")


class StaticCache:
    """The one transform of a frame that never moves: it holds for all times."""

    is_static = True

    def __init__(self) -> None:
        self._kept: Kept | None = None

    def __len__(self) -> int:
        return 1

    def insert(self, new: Kept) -> bool:
        """Take the place of the one from before."""
        self._kept = new
        return True

    def clear(self) -> None:
        """What never moves is not forgotten."""

    def latest_stamp(self) -> int:
        """It has no time: 0."""
        return 0

    oldest_stamp = latest_stamp

    def latest_parent(self) -> str | None:
        """The parent."""
        return self._kept.parent if self._kept else None

    def parent_at(self, time: int) -> str:
        """The parent, at any time."""
        assert self._kept is not None
        return self._kept.parent

    def at(self, time: int) -> Kept:
        """The transform, at any time."""
        assert self._kept is not None
        return self._kept


Cache = TimeCache | StaticCache
