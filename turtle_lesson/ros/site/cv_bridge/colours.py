"""Colours of images: from one order of channels and depth to another, as OpenCV's cvtColor and convertTo do it.

The weights of red, green and blue in a grey value are those of OpenCV's documentation ("Color conversions"), rounded as its
code rounds them for 8 and 16 bits.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

GREY = {"r": 9798, "g": 19235, "b": 3735}
"""0.299, 0.587 and 0.114 as parts of 2¹⁵."""


def is_colour(encoding: str) -> bool:
    """Whether an encoding says what its channels mean: grey, colours, a Bayer pattern; "8UC3" does not."""
    return encoding.startswith(("rgb", "bgr", "mono", "bayer_", "yuv422"))


def convert(image: Array, source: str, target: str, dtype: np.dtype[Any]) -> Array:
    """An image in another encoding, whose channels have this type."""
    if is_colour(source) and is_colour(target):
        image = _with_channels(image, _channels(source), _channels(target))
    return _with_depth(image, dtype)


def _channels(encoding: str) -> str:
    """The channels of an encoding in their order, such as "bgra"; "y" is grey."""
    return encoding.rstrip("0123456789").replace("mono", "y")


def _with_channels(image: Array, source: str, target: str) -> Array:
    if source == target:
        return image
    if target == "y":
        weighted = np.zeros(image.shape[:2], np.int64)
        for name, weight in GREY.items():
            weighted += image[..., source.index(name)].astype(np.int64) * weight
        return ((weighted + (1 << 14)) >> 15).astype(image.dtype)
    opaque = np.full(image.shape[:2], np.iinfo(image.dtype).max, image.dtype)
    grey = image if source == "y" else None
    planes = [
        grey if grey is not None and name != "a" else opaque if name not in source else image[..., source.index(name)]
        for name in target
    ]
    return np.stack(planes, axis=-1)


def _with_depth(image: Array, dtype: np.dtype[Any]) -> Array:
    """The same with another type. Between 8 and 16 bits all is scaled; what does not fit becomes the nearest that does."""
    scale = {(8, 16): 65535 / 255, (16, 8): 255 / 65535}.get((image.itemsize * 8, dtype.itemsize * 8), 1.0)
    if image.dtype == dtype:
        return np.ascontiguousarray(image)
    scaled = image * scale
    if np.issubdtype(dtype, np.integer):
        bounds = np.iinfo(dtype)
        scaled = np.clip(np.rint(scaled), bounds.min, bounds.max)
    return scaled.astype(dtype)
