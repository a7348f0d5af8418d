"""The store of all transforms that were received, and the answers that it gives.

Facts: geometry2, tf2/src/buffer_core.cpp (validateFrameId, setTransformImpl, allFramesAsYAML) and tf2_py/src/tf2_py.cpp.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Sequence
from functools import reduce
from typing import Any

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from rclpy.time import Time

from turtle_lesson.ros.runtime.world import current_process

from ._frames import (
    Frames,
    InvalidArgumentException,
    Kept,
    LookupException,
    TimeCache,
    TransformException,
    combined,
    frames_as_string,
    latest_common_time,
    shown_time,
    transform_between,
)
from ._rotation import canonical

CACHE_TIME = 10_000_000_000
"""How long (ns) transforms are kept unless told otherwise."""
SECOND = 1_000_000_000
SHORTEST = 100_000
"""ns; transforms that came within less time count as if they had taken this long."""


Way = tuple[str, str, int]
"""A target frame, a source frame, and the time (ns) of the transform between them."""


class BufferCore:
    """Keeps transforms for a while (`cache_time`, a Duration; 10 s), and finds those between any two frames.

    Times are rclpy Times or time messages; a time of 0, as in `Time()`, asks for the latest common one.
    """

    def __init__(self, cache_time: Any = None) -> None:
        self._cache_time = CACHE_TIME if cache_time is None else nanoseconds(cache_time, "duration")
        self._frames: dict[str, TimeCache | None] = {}
        self._authorities: dict[str, str] = {}

    def set_transform(self, transform: TransformStamped, authority: str) -> None:
        """Keep the transform of a frame that moves. One that cannot be right is ignored, with a line on stderr."""
        self._set(transform, authority, self._cache_time)

    def set_transform_static(self, transform: TransformStamped, authority: str) -> None:
        """Keep the transform of a frame that never moves: it holds for all times."""
        self._set(transform, authority, None)

    def _set(self, transform: TransformStamped, authority: str, span: int | None) -> None:
        read = read_transform(transform, authority)
        if read is None:
            return
        child, kept = read
        cache = self._frames.get(child)
        if cache is None or cache.span != span:
            cache = self._frames[child] = TimeCache(span)
        self._frames.setdefault(kept.parent, None)
        if cache.insert(kept):
            self._authorities[child] = authority
            return
        what = f"ignoring data from the past for frame {child} at time {shown_time(kept.stamp)}"
        reasons = "Possible reasons are listed at http://wiki.ros.org/tf/Errors%20explained"
        say("Warning:", f"TF_OLD_DATA {what} according to authority {authority}\n{reasons}")

    def clear(self) -> None:
        """Forget all transforms of frames that move; the frames themselves stay known."""
        for cache in self._frames.values():
            if cache is not None:
                cache.clear()

    def lookup_transform_core(self, target_frame: str, source_frame: str, time: Any) -> TransformStamped:
        """Where the source frame is, seen from the target frame, at a time.

        Raises LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException.
        """
        return self._look_up((target_frame, source_frame, nanoseconds(time)))

    def _look_up(self, *ways: Way) -> TransformStamped:
        """The transform along one way, or along two that are joined by a frame that does not move in between."""
        for name, frame in _arguments(ways):
            check_frame(self._frames, frame, f"lookupTransform argument {name}_frame")
        found = [transform_between(self._frames, *way) for way in reversed(ways)]
        turn, place = reduce(combined, [transform for transform, _ in reversed(found)])
        x, y, z, w = canonical(turn)
        message = TransformStamped(child_frame_id=ways[-1][1])
        message.header.frame_id = ways[0][0]
        message.header.stamp = Time(nanoseconds=found[-1][1]).to_msg()
        translation = Vector3(x=place[0], y=place[1], z=place[2])
        message.transform = Transform(translation=translation, rotation=Quaternion(x=x, y=y, z=z, w=w))
        return message

    def _can(self, *ways: Way) -> tuple[bool, str]:
        """Whether it can be looked up, and if not, why."""
        for name, frame in _arguments(ways):
            wrong = wrong_name(frame) or ("" if frame in self._frames else "frame does not exist")
            if wrong:
                return False, f'Invalid frame ID "{frame}" passed to canTransform argument {name}_frame - {wrong}'
        try:
            for way in ways:
                transform_between(self._frames, *way)
        except TransformException as error:
            return False, str(error)
        return True, ""

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """The latest time for which the whole way between two frames is known.

        Raises LookupException, InvalidArgumentException, TransformException.
        """
        for frame in (target_frame, source_frame):
            check_frame(self._frames, frame, "get_latest_common_time")
        return Time(nanoseconds=latest_common_time(self._frames, target_frame, source_frame))

    def all_frames_as_string(self) -> str:
        """A sentence for each frame that has a parent."""
        return frames_as_string(self._frames)

    def all_frames_as_yaml(self) -> str:
        """Each frame that has transforms, as YAML: parent, broadcaster, rate (Hz), and the newest and oldest times."""
        if not self._frames:
            return "[]"
        lines = []
        for name, cache in self._frames.items():
            if not cache or not cache.kept:
                continue
            oldest, latest = cache.kept[0].stamp, cache.kept[-1].stamp
            lines += [
                f"{name}: ",
                f"  parent: '{cache.kept[-1].parent}'",
                f"  broadcaster: '{self._authorities.get(name, 'no recorded authority')}'",
                f"  rate: {len(cache.kept) * 1e9 / max(latest - oldest, SHORTEST):.3f}",
                f"  most_recent_transform: {shown_time(latest)}",
                f"  oldest_transform: {shown_time(oldest)}",
                f"  buffer_length: {(latest - oldest) / 1e9:.3f}",
            ]
        return "".join(f"{line}\n" for line in lines)

    def _frameExists(self, frame_id: str) -> bool:
        """Whether a frame was heard of."""
        return frame_id in self._frames

    def _getFrameStrings(self) -> list[str]:
        """The names of all frames, in the order in which they were heard of."""
        return list(self._frames)


def _arguments(ways: Sequence[Way]) -> list[tuple[str, str]]:
    """The frames of a question, with the names of tf2's arguments for them."""
    (target, fixed, _), (_, source, _) = ways[0], ways[-1]
    ends = [] if len(ways) == 1 and target == source else [("target", target), ("source", source)]
    return ends if len(ways) == 1 else [*ends, ("fixed", fixed)]


def nanoseconds(value: Any, what: str = "time") -> int:
    """A time or duration in ns, given as rclpy's or as a message. Raises TypeError."""
    if hasattr(value, "sec") and hasattr(value, "nanosec"):
        return value.sec * 1_000_000_000 + value.nanosec
    if hasattr(value, "nanoseconds"):
        return value.nanoseconds
    raise TypeError(f"a {what} is expected, got {value!r}: write {what.title()}(seconds=…)")


def check_frame(frames: Frames, frame: Any, argument: str) -> str:
    """The name of a frame that there is. Raises InvalidArgumentException, LookupException, TypeError."""
    wrong = wrong_name(frame)
    if wrong:
        raise InvalidArgumentException(f'Invalid argument "{frame}" passed to {argument} - {wrong}')
    if frame not in frames:
        error = LookupException(f'"{frame}" passed to {argument} does not exist. ')
        missing = "none; is a broadcaster running, and is the node with the TransformListener spinning?"
        error.add_note(f"Frames received so far: {', '.join(frames) or missing}")
        raise error
    return frame


def wrong_name(frame: Any) -> str:
    """Why this can be no frame's name; "" if it can."""
    if not isinstance(frame, str):
        raise TypeError(f"a frame's name must be a str, got {frame!r}")
    if not frame:
        return "in tf2 frame_ids cannot be empty"
    return "in tf2 frame_ids cannot start with a '/'" if frame.startswith("/") else ""


def read_transform(transform: Any, authority: str) -> tuple[str, Kept] | None:
    """A TransformStamped as (child, what is kept of it); None if tf2 ignores it, which is said on the console."""
    parent = transform.header.frame_id.removeprefix("/")
    child = transform.child_frame_id.removeprefix("/")
    place, turn = transform.transform.translation, transform.transform.rotation
    where = (place.x, place.y, place.z)
    how = canonical((turn.x, turn.y, turn.z, turn.w))
    has_nan, no_turn = any(map(math.isnan, (*where, *how))), any(map(math.isnan, how))  # `how` is of length 1, or NaN
    if parent and child and parent != child and not has_nan:
        return child, Kept(nanoseconds(transform.header.stamp), parent, how, where)
    by = f'from authority "{authority}"'
    same = f'with frame_id and  child_frame_id "{child}" because they are the same'
    values, quaternion = (f"({' '.join(f'{each:f}' for each in numbers)})" for numbers in (where, how))
    of_child = f'Ignoring transform for child_frame_id "{child}" {by}'
    found = {
        f"TF_SELF_TRANSFORM: Ignoring transform {by} {same}": child == parent,
        f"TF_NO_CHILD_FRAME_ID: Ignoring transform {by} because child_frame_id not set ": not child,
        f'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "{child}"  {by} because frame_id not set': not parent,
        f"TF_NAN_INPUT: {of_child} because of a nan value in the transform {values} {quaternion}": has_nan,
        f"TF_DENORMALIZED_QUATERNION: {of_child} because of an invalid quaternion in the transform {quaternion}": no_turn,
    }
    for refusal, is_so in found.items():
        if is_so:
            say("Error:  ", refusal)
    return None


class _Said(dict[str, int]):
    """When complaints of each kind were printed last, ns."""


def say(level: str, text: str) -> None:
    """Print what tf2 prints without a logger: to the running program's stderr, in a cell to its output.

    A complaint of the same kind about the same frame is printed once a second at most, not for each message.
    """
    process = current_process()
    now, said = process.simulation.now, process.state(_Said)
    kind = re.sub(r"\d", "", text)  # the figures change from message to message
    if now - said.get(kind, -SECOND) >= SECOND:
        said[kind] = now
        print(level, text, file=sys.stdout if process.is_notebook else sys.stderr)
