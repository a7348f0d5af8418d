"""The tree of frames: the transforms that are kept of each, and the way from one frame to another.

Facts: geometry2, tf2/src/cache.cpp, static_cache.cpp and buffer_core.cpp (walkToTopParent, getLatestCommonTime), with its
messages. Times are in ns; 0 means "the latest".
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Mapping, Sequence
from operator import attrgetter
from typing import NamedTuple

from ._rotation import NO_TURN, ORIGIN, Quaternion, Vector, add, inverse, lerp, multiply, rotate, slerp


class TransformException(Exception):
    """Something is wrong with a transform; the others are kinds of it. Tracebacks call them `tf2.…`, as the real ones."""

    __module__ = "tf2"

    def __init_subclass__(cls) -> None:
        cls.__module__ = "tf2"


class ConnectivityException(TransformException):
    """Two frames hang on trees that are not connected."""


class LookupException(TransformException):
    """A frame is asked for that is not known."""


class ExtrapolationException(TransformException):
    """A time is asked for that the kept transforms do not reach to."""


class InvalidArgumentException(TransformException):
    """A frame's name is none: empty, or with a slash before it."""


class TimeoutException(TransformException):
    """Nothing came in time."""


class Kept(NamedTuple):
    """One transform: where a frame is, seen from its parent, at a time (ns)."""

    stamp: int
    parent: str
    turn: Quaternion
    place: Vector


_stamp_of = attrgetter("stamp")


class Unreachable(Exception):
    """No transform at the time that was asked for; the text says why, and may be empty."""


def shown_time(stamp: int) -> str:
    """A time (ns) as tf2's messages show it: seconds with six decimals."""
    return f"{stamp / 1e9:.6f}"


class TimeCache:
    """The transforms of a frame, as long as `span` (ns) back from the latest.

    Without a span the frame never moves: its one transform has no time (0), and holds for all times.
    """

    def __init__(self, span: int | None) -> None:
        self.span = span
        self.kept: list[Kept] = []

    def insert(self, new: Kept) -> bool:
        """Keep one more; False if it is older than what is kept."""
        if self.span is None:
            self.kept = [new._replace(stamp=0)]
            return True
        oldest = self.latest_stamp() - self.span
        del self.kept[: bisect_left(self.kept, oldest, key=_stamp_of)]
        if self.kept and new.stamp < oldest:
            return False
        end = bisect_right(self.kept, new.stamp, key=_stamp_of)
        if new not in self.kept[bisect_left(self.kept, new.stamp, key=_stamp_of) : end]:
            self.kept.insert(end, new)
        return True

    def clear(self) -> None:
        """Forget everything, but of a frame that never moves."""
        if self.span is not None:
            self.kept.clear()

    def latest_stamp(self) -> int:
        """The time of the latest; 0 if there is none."""
        return self.kept[-1].stamp if self.kept else 0

    def at(self, time: int) -> Kept:
        """The transform at a time, between two kept ones if need be. Raises Unreachable."""
        if not self.kept:
            raise Unreachable("")
        oldest, latest = self.kept[0], self.kept[-1]
        if self.span is None or time in (0, latest.stamp):
            return latest
        why_not = ""
        if oldest is latest:
            why_not = f"at time {shown_time(time)}, but only time {shown_time(latest.stamp)} is in the buffer"
        elif time > latest.stamp:
            known = f"but the latest data is at time {shown_time(latest.stamp)}"
            why_not = f"into the future.  Requested time {shown_time(time)} {known}"
        elif time < oldest.stamp:
            known = f"but the earliest data is at time {shown_time(oldest.stamp)}"
            why_not = f"into the past.  Requested time {shown_time(time)} {known}"
        if why_not:
            raise Unreachable(f"Lookup would require extrapolation {why_not}")
        after = bisect_right(self.kept, time, key=_stamp_of)
        one, two = self.kept[after - 1], self.kept[after]
        if one.stamp == time or one.parent != two.parent:
            return one
        share = (time - one.stamp) / (two.stamp - one.stamp)
        return Kept(one.stamp, one.parent, slerp(one.turn, two.turn, share), lerp(one.place, two.place, share))


Frames = Mapping[str, TimeCache | None]
"""What is kept of each frame; None for one that is only known as the parent of others."""
Transform = tuple[Quaternion, Vector]
Step = tuple[str, Kept]
"""A frame, and its transform."""

DEEPEST = 1000
"""A way through more frames than this goes round in a loop."""


def frames_as_string(frames: Frames) -> str:
    """A sentence for each frame that has a parent, or had one."""
    return "".join(
        f"Frame {name} exists with parent {cache.kept[-1].parent if cache.kept else 'NO_PARENT'}.\n"
        for name, cache in frames.items()
        if cache is not None
    )


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
    up, _, _ = _climb(frames, source, [target], 0)
    above = [source, *(kept.parent for _, kept in up)]
    down, bottom, _ = _climb(frames, target, above, 0)
    if bottom not in above:
        raise _unconnected(target, source)
    stamps = [kept.stamp for _, kept in (*up[: above.index(bottom)], *down)]
    return min(filter(None, stamps), default=0)


def _climb(frames: Frames, frame: str, goals: Sequence[str], time: int) -> tuple[list[Step], str, str]:
    """Go up from a frame, to a goal or the root: the steps, where they led, and why they led no further."""
    steps: list[Step] = []
    for _ in range(DEEPEST + 1):
        cache = frames.get(frame)
        if cache is None or frame in goals:
            return steps, frame, ""
        try:
            kept = cache.at(time)
        except Unreachable as error:
            return steps, frame, str(error)
        steps.append((frame, kept))
        frame = kept.parent
    raise LookupException(f"The tf tree is invalid because it contains a loop.\n{frames_as_string(frames)}\n")


def transform_between(frames: Frames, target: str, source: str, time: int) -> tuple[Transform, int]:
    """Where the source frame is, seen from the target frame, at a time (ns; 0 for the latest common one), and this time.

    Raises LookupException, ConnectivityException, ExtrapolationException.
    """
    time = time or latest_common_time(frames, target, source)
    up, top, why_not = _climb(frames, source, [target], time)
    down, bottom, problem = _climb(frames, target, [top, source], time)
    if bottom == source:
        up = []
    elif bottom != top:
        if problem := problem or why_not:
            raise ExtrapolationException(
                f"{problem}, when looking up transform from frame [{source}] to frame [{target}]"
            )
        raise _unconnected(target, source)
    return combined(inverted(_summed(down)), _summed(up)), time


def _summed(steps: list[Step]) -> Transform:
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
