"""All frames as YAML. Facts: geometry2, tf2/src/buffer_core.cpp (allFramesAsYAML)."""

from __future__ import annotations

from collections.abc import Mapping

from ._cache import Cache, shown_time
from ._walk import Frames

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
