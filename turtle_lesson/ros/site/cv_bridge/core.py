"""`CvBridge` with numpy alone: the encodings that programs use, laid out as in cv_bridge's core.py.

What it refuses and in which words, from core.py and cv_bridge.cpp (https://github.com/ros-perception/vision_opencv).
"""

from __future__ import annotations

import importlib
import re
from array import array
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

Array = NDArray[Any]

TYPES = {
    "8U": "uint8", "8S": "int8", "16U": "uint16", "16S": "int16", "32S": "int32", "32F": "float32", "64F": "float64",
}  # fmt: skip
"""OpenCV's depths, and what numpy calls them."""

_ENCODING = re.compile(r"(?P<colours>mono|rgba?|bgra?)(?P<bits>8|16)|(?P<depth>\d+[USF])C(?P<channels>[1-9]\d*)")

GREY = {"r": 9798, "g": 19235, "b": 3735}
"""0.299, 0.587 and 0.114 as parts of 2¹⁵."""


class CvBridgeError(TypeError):
    """An image cannot be converted."""


class CvBridge:
    """Converts between image messages and arrays of numpy, which are what OpenCV works with in Python."""

    def imgmsg_to_cv2(self, img_msg: Image, desired_encoding: str = "passthrough") -> Array:
        """The image of a message, as it is encoded there or in another encoding.

        Raises CvBridgeError if there is no such encoding, or no way from one to the other.
        """
        kind, channels, _ = _layout(img_msg.encoding)
        dtype = kind.newbyteorder(">" if img_msg.is_bigendian else "<")
        columns = img_msg.step // (dtype.itemsize * channels) or img_msg.width
        shape = (img_msg.height, columns, channels) if channels > 1 else (img_msg.height, columns)
        image: Array = np.ndarray(shape, dtype, img_msg.data)[:, : img_msg.width].astype(kind, copy=False)
        return image if desired_encoding == "passthrough" else _converted(image, img_msg.encoding, desired_encoding)

    def cv2_to_imgmsg(self, cvim: Array, encoding: str = "passthrough", header: Header | None = None) -> Image:
        """The message for an image, which must be encoded as `encoding` says; "passthrough" names its type only.

        Raises TypeError if the image is no array, and CvBridgeError if the array's type cannot be that of the encoding.
        """
        if not isinstance(cvim, np.ndarray):
            raise TypeError("Your input type is not a numpy array")
        height, width, *rest = cvim.shape
        depth = next((depth for depth, name in TYPES.items() if name == cvim.dtype.name), None)
        if depth is None:
            raise CvBridgeError(f"OpenCV has no images of the type {cvim.dtype}: convert it, as .astype(np.uint8) does")
        kind = f"{depth}C{rest[0] if rest else 1}"
        if encoding != "passthrough" and _layout(encoding)[:2] != _layout(kind)[:2]:
            raise CvBridgeError(f"encoding specified as {encoding}, but image has incompatible type {kind}")
        message = Image(height=height, width=width, encoding=kind if encoding == "passthrough" else encoding)
        if header is not None:
            message.header = header
        message.is_bigendian = int(cvim.dtype.byteorder == ">")
        message.data = array("B", cvim.tobytes())
        message.step = len(message.data) // height if height else 0
        return message

    def compressed_imgmsg_to_cv2(self, cmprs_img_msg: CompressedImage, desired_encoding: str = "passthrough") -> Array:
        """The image of a compressed message. Raises ImportError if OpenCV is not installed."""
        cv2 = importlib.import_module("cv2")
        image: Array = cv2.imdecode(np.frombuffer(cmprs_img_msg.data, np.uint8), cv2.IMREAD_UNCHANGED)
        return image if desired_encoding == "passthrough" else _converted(image, "bgr8", desired_encoding)

    def cv2_to_compressed_imgmsg(self, cvim: Array, dst_format: str = "jpg") -> CompressedImage:
        """The compressed message for an array. Raises ImportError if OpenCV is not installed."""
        data = importlib.import_module("cv2").imencode(f".{dst_format}", cvim)[1]
        return CompressedImage(format=dst_format, data=array("B", data.tobytes()))


def _layout(encoding: str) -> tuple[np.dtype[Any], int, str]:
    """The type of an encoding's numbers, how many a pixel has, and their meanings ("bgr"; "y" is grey, "8UC3" has none)."""
    found = _ENCODING.fullmatch(encoding)
    if found is None or (found["depth"] and found["depth"] not in TYPES):
        raise CvBridgeError(f"Unrecognized image encoding [{encoding}]")
    if found["depth"]:
        return np.dtype(TYPES[found["depth"]]), int(found["channels"]), ""
    colours = found["colours"].replace("mono", "y")
    return np.dtype(f"uint{found['bits']}"), len(colours), colours


def _converted(image: Array, source: str, target: str) -> Array:
    """An image in another encoding, as a new array."""
    old_dtype, channels, old = _layout(source)
    dtype, wanted, new = _layout(target)
    if new and not old:
        raise CvBridgeError(f"[{source}] is not a color format. but [{target}] is. The conversion does not make sense")
    if new and dtype != old_dtype:
        raise CvBridgeError(
            f"[{source}] to [{target}]: 8 to 16 bits and back is available with OpenCV's cv_bridge only"
        )
    if not new and wanted != channels:
        raise CvBridgeError(f"[{source}] and [{target}] do not have the same number of channel")
    return (_recoloured(image, old, new) if new and new != old else image).astype(dtype)


def _recoloured(image: Array, source: str, target: str) -> Array:
    """The same picture with other colours, or with the same in another order."""
    if target == "y":
        weights = [GREY.get(name, 0) for name in source]
        return (image.astype(np.int64) @ weights + (1 << 14)) >> 15
    channels = {"a": np.full(image.shape[:2], np.iinfo(image.dtype).max, image.dtype)}
    channels |= dict.fromkeys("rgb", image) if source == "y" else {name: image[..., i] for i, name in enumerate(source)}
    return np.stack([channels[name] for name in target], axis=-1)
