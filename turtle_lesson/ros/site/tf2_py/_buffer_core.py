"""The store of all transforms that were heard of, and the answers that it gives.

Facts: geometry2, tf2/src/buffer_core.cpp and tf2_py/src/tf2_py.cpp.
"""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from rclpy.time import Time

from ._arguments import check_frame, frames_as_yaml, nanoseconds, read_transform, say, wrong_name
from ._cache import Cache, StaticCache, TimeCache, shown_time
from ._exceptions import TransformException
from ._rotation import canonical
from ._walk import Transform as Pair
from ._walk import Way, combined, frames_as_string, latest_common_time

CACHE_TIME = 10_000_000_000
"""How long (ns) transforms are kept unless told otherwise."""


class BufferCore:
    """Keeps transforms for a while (`cache_time`, a Duration; 10 s), and finds those between any two frames.

    Times are rclpy Times or time messages; a time of 0, as in `Time()`, asks for the latest common one.
    """

    def __init__(self, cache_time: Any = None) -> None:
        self._cache_time = CACHE_TIME if cache_time is None else nanoseconds(cache_time, "duration")
        self._frames: dict[str, Cache | None] = {}
        self._authorities: dict[str, str] = {}

    # -- telling -------------------------------------------------------------------------------------------

    def set_transform(self, transform: TransformStamped, authority: str) -> None:
        """Keep the transform of a frame that moves. One that cannot be right is ignored, with a line on stderr."""
        self._set(transform, authority, TimeCache)

    def set_transform_static(self, transform: TransformStamped, authority: str) -> None:
        """Keep the transform of a frame that never moves: it holds for all times."""
        self._set(transform, authority, StaticCache)

    def _set(self, transform: TransformStamped, authority: str, kind: type) -> None:
        read = read_transform(transform, authority)
        if read is None:
            return
        child, kept = read
        cache = self._frames.get(child)
        if type(cache) is not kind:
            cache = self._frames[child] = TimeCache(self._cache_time) if kind is TimeCache else StaticCache()
        self._frames.setdefault(kept.parent, None)
        assert cache is not None
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

    # -- asking --------------------------------------------------------------------------------------------

    def lookup_transform_core(self, target_frame: str, source_frame: str, time: Any) -> TransformStamped:
        """Where the source frame is, seen from the target frame, at a time.

        Raises LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException.
        """
        pair, stamp = self._lookup(target_frame, source_frame, nanoseconds(time))
        return _as_message(pair, stamp, target_frame, source_frame)

    def lookup_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> TransformStamped:
        """Where the source frame was at its time, seen from where the target frame is at its own.

        What joins the two times is a frame that does not move between them. Raises as `lookup_transform_core`.
        """
        for name, frame in (("target", target_frame), ("source", source_frame), ("fixed", fixed_frame)):
            check_frame(self._frames, frame, f"lookupTransform argument {name}_frame")
        inner, _ = self._lookup(fixed_frame, source_frame, nanoseconds(source_time))
        outer, stamp = self._lookup(target_frame, fixed_frame, nanoseconds(target_time))
        return _as_message(combined(outer, inner), stamp, target_frame, source_frame)

    def _lookup(self, target: str, source: str, time: int) -> tuple[Pair, int]:
        if target == source:
            cache = self._frames.get(target)
            return Way(self._frames, target, source, time).transform(), time or (cache.latest_stamp() if cache else 0)
        check_frame(self._frames, target, "lookupTransform argument target_frame")
        check_frame(self._frames, source, "lookupTransform argument source_frame")
        way = Way(self._frames, target, source, time)
        return way.transform(), way.time

    def can_transform_core(self, target_frame: str, source_frame: str, time: Any) -> tuple[bool, str]:
        """Whether there is such a transform, and if not, why."""
        moment = nanoseconds(time)
        if target_frame == source_frame:
            return True, ""
        why_not = self._why_not(target_frame, "target") or self._why_not(source_frame, "source")
        why_not = why_not or self._no_way(target_frame, source_frame, moment)
        return not why_not, why_not

    def can_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> tuple[bool, str]:
        """Whether there is such a transform between two times, and if not, why."""
        moments = nanoseconds(target_time), nanoseconds(source_time)
        frames = (target_frame, "target"), (source_frame, "source"), (fixed_frame, "fixed")
        why_not = next(filter(None, (self._why_not(frame, name) for frame, name in frames)), "")
        why_not = why_not or self._no_way(target_frame, fixed_frame, moments[0])
        why_not = why_not or self._no_way(fixed_frame, source_frame, moments[1])
        return not why_not, why_not

    def _why_not(self, frame: str, name: str) -> str:
        wrong = wrong_name(frame) or ("" if frame in self._frames else "frame does not exist")
        return wrong and f'Invalid frame ID "{frame}" passed to canTransform argument {name}_frame - {wrong}'

    def _no_way(self, target: str, source: str, time: int) -> str:
        try:
            Way(self._frames, target, source, time)
        except TransformException as error:
            return str(error)
        return ""

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """The latest time for which the whole way between two frames is known.

        Raises LookupException, InvalidArgumentException, TransformException.
        """
        for frame in (target_frame, source_frame):
            check_frame(self._frames, frame, "get_latest_common_time")
        return Time(nanoseconds=latest_common_time(self._frames, target_frame, source_frame))

    # -- all frames ----------------------------------------------------------------------------------------

    def all_frames_as_string(self) -> str:
        """A sentence for each frame that has a parent."""
        return frames_as_string(self._frames)

    def all_frames_as_yaml(self) -> str:
        """Each frame with its parent, rate and times, as YAML."""
        return frames_as_yaml(self._frames, self._authorities)

    def _frameExists(self, frame_id: str) -> bool:
        """Whether a frame was heard of."""
        return frame_id in self._frames

    def _getFrameStrings(self) -> list[str]:
        """The names of all frames, in the order in which they were heard of."""
        return list(self._frames)

    def _chain(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> list[str]:
        """The frames on the way from the source to the target by the fixed frame."""
        up = Way(self._frames, fixed_frame, source_frame, nanoseconds(source_time)).chain(source_frame)
        down = Way(self._frames, target_frame, fixed_frame, nanoseconds(target_time)).chain(fixed_frame)
        return list(dict.fromkeys([*up, *down]))

    def _allFramesAsDot(self, time: Any = None) -> str:
        """Not here: a drawing for Graphviz. Raises NotImplementedError."""
        raise NotImplementedError(
            "_allFramesAsDot() is not available here: print(buffer.all_frames_as_yaml()), "
            "or ros2 run tf2_tools view_frames"
        )


def _as_message(pair: Pair, stamp: int, target: str, source: str) -> TransformStamped:
    turn, place = pair
    x, y, z, w = canonical(turn)
    message = TransformStamped(child_frame_id=source)
    message.header.frame_id = target
    message.header.stamp = Time(nanoseconds=stamp).to_msg()
    translation = Vector3(x=place[0], y=place[1], z=place[2])
    message.transform = Transform(translation=translation, rotation=Quaternion(x=x, y=y, z=z, w=w))
    return message
