"""The tree of frames: the transforms that are kept of each, and the way from one frame to another.

Facts: geometry2, tf2/src/cache.cpp, static_cache.cpp and buffer_core.cpp (walkToTopParent, getLatestCommonTime), with its
messages. Times are in ns; 0 means "the latest".
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from ._rotation import NO_TURN, ORIGIN, Quaternion, Vector, add, inverse, lerp, multiply, rotate, slerp


class TransformException(Exception):
    """Something is wrong with a transform; the others are kinds of it. Tracebacks call them `tf2.…`, as the real ones."""

    __module__ = "tf2"


class ConnectivityException(TransformException):
    """Two frames hang on trees that are not connected."""

    __module__ = "tf2"


class LookupException(TransformException):
    """A frame is asked for that is not known."""

    __module__ = "tf2"


class ExtrapolationException(TransformException):
    """A time is asked for that the kept transforms do not reach to."""

    __module__ = "tf2"


class InvalidArgumentException(TransformException):
    """A frame's name is none: empty, or with a slash before it."""

    __module__ = "tf2"


class TimeoutException(TransformException):
    """Nothing came in time."""

    __module__ = "tf2"


# -- one frame ----------------------------------------------------------------------------------------------------------


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


# -- ways ---------------------------------------------------------------------------------------------------------------

Frames = Mapping[str, Cache | None]
"""What is kept of each frame; None for one that is only known as the parent of others."""
Transform = tuple[Quaternion, Vector]

DEEPEST = 1000
"""A way through more frames than this goes round in a loop."""


def frames_as_string(frames: Frames) -> str:
    """A sentence for each frame that has a parent, or had one."""
    lines = (
        f"Frame {name} exists with parent {cache.latest_parent() or 'NO_PARENT'}.\n"
        for name, cache in frames.items()
        if cache is not None
    )
    return "".join(lines)


def _loop(frames: Frames) -> LookupException:
    return LookupException(f"The tf tree is invalid because it contains a loop.\n{frames_as_string(frames)}\n")


def _unconnected(target: str, source: str) -> ConnectivityException:
    return ConnectivityException(
        f"Could not find a connection between '{target}' and '{source}' because they are not part of the same tree."
        "Tf has two or more unconnected trees."
    )


def latest_common_time(frames: Frames, target: str, source: str) -> int:
    """The latest time (ns) for which the whole way between two frames is known; 0 if all of it is static.

    Raises ConnectivityException, LookupException.
    """
    if target == source:
        cache = frames.get(source)
        return cache.latest_stamp() if cache else 0
    up: dict[str, int | None] = {}
    earliest: int | None = None
    for stamp, parent in _latest_steps(frames, source):
        earliest = _earlier(earliest, stamp)
        if parent == target:
            return earliest or 0
        up[parent] = earliest
    down: int | None = None
    for stamp, parent in _latest_steps(frames, target):
        down = _earlier(down, stamp)
        if parent == source:
            return down or 0
        if parent in up:
            return _earlier(down, up[parent] or 0) or 0
    raise _unconnected(target, source)


def _earlier(known: int | None, stamp: int) -> int | None:
    """The earlier of two times; a time of 0 is that of a static frame, and holds forever."""
    if not stamp:
        return known
    return stamp if known is None else min(known, stamp)


def _latest_steps(frames: Frames, frame: str) -> Iterator[tuple[int, str]]:
    """From a frame up to its root: the time of each latest transform, and the parent in it."""
    for _ in range(DEEPEST + 1):
        cache = frames.get(frame)
        parent = None if cache is None else cache.latest_parent()
        if cache is None or parent is None:
            return
        yield cache.latest_stamp(), parent
        frame = parent
    raise _loop(frames)


class Way:
    """The way from a source frame up, and down again to a target frame, at a time (ns; 0 for the latest common one).

    Raises LookupException, ConnectivityException, ExtrapolationException.
    """

    def __init__(self, frames: Frames, target: str, source: str, time: int) -> None:
        self.up: list[tuple[str, Kept]] = []
        self.down: list[tuple[str, Kept]] = []
        self.time = time
        if target == source:
            return
        self.time = time or latest_common_time(frames, target, source)
        self._frames, self._target, self._source = frames, target, source
        self._go()

    def _go(self) -> None:
        top, why_not = self._climb(self._source, self._target, self.up)
        if top == self._target:
            return
        bottom, problem = self._climb(self._target, top, self.down)
        if bottom == top:
            return
        if bottom == self._source:
            self.up.clear()
            return
        problem = problem or why_not
        if problem:
            ends = f"frame [{self._source}] to frame [{self._target}]"
            raise ExtrapolationException(f"{problem}, when looking up transform from {ends}")
        raise _unconnected(self._target, self._source)

    def _climb(self, frame: str, goal: str, steps: list[tuple[str, Kept]]) -> tuple[str, str]:
        """Go up from a frame, to the goal or the root; where that led, and why it led no further."""
        for _ in range(DEEPEST + 1):
            cache = self._frames.get(frame)
            if cache is None or frame == goal or (steps is self.down and frame == self._source):
                return frame, ""
            try:
                kept = cache.at(self.time)
            except Unreachable as error:
                return frame, str(error)
            steps.append((frame, kept))
            frame = kept.parent
        raise _loop(self._frames)

    def transform(self) -> Transform:
        """Where the source frame is, seen from the target frame."""
        return combined(inverted(_summed(self.down)), _summed(self.up))

    def chain(self, source: str) -> list[str]:
        """The frames on the way from the source on, with those at both ends."""
        up = [source, *(kept.parent for _, kept in self.up)]
        return [*up, *(name for name, _ in reversed(self.down))]


def _summed(steps: list[tuple[str, Kept]]) -> Transform:
    turn, place = NO_TURN, ORIGIN
    for _, kept in steps:
        turn, place = multiply(kept.turn, turn), add(rotate(kept.turn, place), kept.place)
    return turn, place


def inverted(transform: Transform) -> Transform:
    """The transform the other way round."""
    turn, (x, y, z) = transform
    back = inverse(turn)
    return back, rotate(back, (-x, -y, -z))


def combined(outer: Transform, inner: Transform) -> Transform:
    """The inner transform, and then the outer one."""
    (turn, place), (inner_turn, inner_place) = outer, inner
    return multiply(turn, inner_turn), add(rotate(turn, inner_place), place)
