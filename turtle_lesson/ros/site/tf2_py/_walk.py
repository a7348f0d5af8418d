"""Ways through the tree of frames: from one frame up to where it meets the way up from another.

Facts: geometry2, tf2/src/buffer_core.cpp (walkToTopParent, getLatestCommonTime), with its messages.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ._cache import Cache, Kept, Unreachable
from ._exceptions import ConnectivityException, ExtrapolationException, LookupException
from ._rotation import NO_TURN, ORIGIN, Quaternion, Vector, add, inverse, multiply, rotate

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
