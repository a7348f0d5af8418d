"""What may be given to a BufferCore: times, durations, frames and transforms; what is refused, and how tf2 says so.

Facts: geometry2, tf2_py/src/tf2_py.cpp (conversions), tf2/src/buffer_core.cpp (validateFrameId, setTransformImpl).
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Mapping
from typing import Any

from rclpy._deadlock import is_notebook

from turtle_lesson.ros.runtime.world import current_process

from ._cache import Cache, Kept, shown_time
from ._exceptions import InvalidArgumentException, LookupException
from ._rotation import Quaternion, Vector, canonical
from ._walk import Frames

SECOND = 1_000_000_000
TOLERANCE = 10e-3
"""How far the squared length of a quaternion may be off 1."""


def nanoseconds(value: Any, what: str = "time") -> int:
    """A time or duration in ns, given as rclpy's or as a message. Raises TypeError."""
    if hasattr(value, "sec") and hasattr(value, "nanosec"):
        return value.sec * 1_000_000_000 + value.nanosec
    if hasattr(value, "nanoseconds"):
        return value.nanoseconds
    kind = "Time" if what == "time" else "Duration"
    hint = f"got {value!r}; write rclpy.{kind.lower()}.{kind}(seconds=…)"
    raise TypeError(f"{what} must have sec and nanosec, or nanoseconds: {hint}")


def check_frame(frames: Frames, frame: Any, argument: str) -> str:
    """The name of a frame that there is. Raises InvalidArgumentException, LookupException, TypeError."""
    wrong = wrong_name(frame)
    if wrong:
        raise InvalidArgumentException(f'Invalid argument "{frame}" passed to {argument} - {wrong}')
    if frame not in frames:
        error = LookupException(f'"{frame}" passed to {argument} does not exist. ')
        error.add_note(_known(frames))
        raise error
    return frame


def wrong_name(frame: Any) -> str:
    """Why this can be no frame's name; "" if it can."""
    if not isinstance(frame, str):
        raise TypeError(f"a frame's name must be a str, got {frame!r}")
    if not frame:
        return "in tf2 frame_ids cannot be empty"
    return "in tf2 frame_ids cannot start with a '/'" if frame.startswith("/") else ""


def _known(frames: Frames) -> str:
    if frames:
        return f"Frames received so far: {', '.join(frames)}."
    return "No transform has been received yet: is a broadcaster running, and is the node with the TransformListener spinning?"


def read_transform(transform: Any, authority: str) -> tuple[str, Kept] | None:
    """A TransformStamped as (child, what is kept of it); None if tf2 ignores it, which is said on the console."""
    parent = transform.header.frame_id.removeprefix("/")
    child = transform.child_frame_id.removeprefix("/")
    place, turn = transform.transform.translation, transform.transform.rotation
    where = (place.x, place.y, place.z)
    how = canonical((turn.x, turn.y, turn.z, turn.w))
    if not (parent and child and parent != child and _is_sound(where, how)):
        for refusal in _refusals(parent, child, where, how, authority):
            say("Error:  ", refusal)
        return None
    return child, Kept(nanoseconds(transform.header.stamp), parent, how, where)


def _is_sound(place: Vector, turn: Quaternion) -> bool:
    """Whether these are numbers, and the quaternion has a length of about 1."""
    x, y, z, w = turn
    length_is_one = abs(x * x + y * y + z * z + w * w - 1.0) < TOLERANCE
    return length_is_one and not any(map(math.isnan, place))


def _refusals(parent: str, child: str, place: tuple[float, ...], turn: tuple[float, ...], authority: str) -> list[str]:
    by = f'from authority "{authority}"'
    found = []
    if child == parent:
        same = f'with frame_id and  child_frame_id "{child}" because they are the same'
        found.append(f"TF_SELF_TRANSFORM: Ignoring transform {by} {same}")
    if not child:
        found.append(f"TF_NO_CHILD_FRAME_ID: Ignoring transform {by} because child_frame_id not set ")
    if not parent:
        found.append(f'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "{child}"  {by} because frame_id not set')
    quaternion = f"({' '.join(f'{each:f}' for each in turn)})"
    if any(map(math.isnan, (*place, *turn))):
        values = f"because of a nan value in the transform ({' '.join(f'{each:f}' for each in place)}) {quaternion}"
        found.append(f'TF_NAN_INPUT: Ignoring transform for child_frame_id "{child}" {by} {values}')
    if not abs(sum(each * each for each in turn) - 1.0) < TOLERANCE:
        values = f"because of an invalid quaternion in the transform {quaternion}"
        found.append(f'TF_DENORMALIZED_QUATERNION: Ignoring transform for child_frame_id "{child}" {by} {values}')
    return found


def say(level: str, text: str) -> None:
    """Print what tf2 prints without a logger: to the running program's stderr, in a cell to its output.

    A complaint of the same kind about the same frame is printed once a second at most, not for each message.
    """
    process = current_process()
    now, said = process.simulation.now, process.locals.setdefault("tf2.said", {})
    kind = re.sub(r"\d", "", text)  # the figures change from message to message
    if now - said.get(kind, -SECOND) >= SECOND:
        said[kind] = now
        print(level, text, file=sys.stdout if is_notebook(process) else sys.stderr)


# -- yaml ---------------------------------------------------------------------------------------------------------
# All frames as YAML. Facts: geometry2, tf2/src/buffer_core.cpp (allFramesAsYAML).

SHORTEST = 100_000
"""ns; transforms that came within less time count as if they had taken this long."""


def frames_as_yaml(frames: Frames, authorities: Mapping[str, str]) -> str:
    """Each frame that has transforms: parent, who told it, how often (Hz), and the times of the newest and oldest."""
    if not frames:
        return "[]"
    return "".join(
        _entry(name, cache, authorities.get(name, "no recorded authority"))
        for name, cache in frames.items()
        if cache is not None and cache.latest_parent() is not None
    )


def _entry(name: str, cache: Cache, authority: str) -> str:
    newest, oldest = cache.latest_stamp(), cache.oldest_stamp()
    rate = len(cache) * 1e9 / max(newest - oldest, SHORTEST)
    lines = (
        f"{name}: ",
        f"  parent: '{cache.latest_parent()}'",
        f"  broadcaster: '{authority}'",
        f"  rate: {rate:.3f}",
        f"  most_recent_transform: {shown_time(newest)}",
        f"  oldest_transform: {shown_time(oldest)}",
        f"  buffer_length: {(newest - oldest) / 1e9:.3f}",
    )
    return "".join(f"{line}\n" for line in lines)
