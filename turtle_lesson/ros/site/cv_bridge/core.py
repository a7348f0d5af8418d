"""`CvBridge` with numpy alone: which encodings there are and how they are laid out, from cv_bridge's core.py.

What it refuses and in which words, from core.py and cv_bridge.cpp (https://github.com/ros-perception/vision_opencv).
"""

from __future__ import annotations

import importlib
import re
import sys
from array import array
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import CompressedImage, Image

Array = NDArray[Any]

TYPES = {
    "8U": "uint8", "8S": "int8", "16U": "uint16", "16S": "int16", "32S": "int32", "32F": "float32", "64F": "float64",
}  # fmt: skip
"""OpenCV's depths in the order of their numbers, and what numpy calls them."""

_DEPTHS = list(TYPES)
_COLOURS = re.compile(r"(?:(mono)|(?:rgb|bgr)(a?))(8|16)")
_BAYER = re.compile(r"bayer_(?:rggb|bggr|gbrg|grbg)(8|16)")
_GENERIC = re.compile(r"(8U|8S|16U|16S|32S|32F|64F)C([1-9]\d*)")


GREY = {"r": 9798, "g": 19235, "b": 3735}
"""0.299, 0.587 and 0.114 as parts of 2¹⁵."""


class CvBridgeError(TypeError):
    """An image cannot be converted."""


class CvBridge:
    """Converts between image messages and arrays of numpy, which are what OpenCV works with in Python."""

    def __init__(self) -> None:
        names = [f"{depth}C{channels}" for depth in _DEPTHS for channels in range(1, 5)]
        self.cvtype_to_name = {self.encoding_to_cvtype2(name): name for name in names}
        self.numpy_type_to_cvtype = {**{name: depth for depth, name in TYPES.items()}, **TYPES}

    def dtype_with_channels_to_cvtype2(self, dtype: np.dtype[Any], n_channels: int) -> str:
        """The name of OpenCV's type for arrays of this type, such as "8UC3"."""
        return f"{self.numpy_type_to_cvtype[dtype.name]}C{n_channels}"

    def cvtype2_to_dtype_with_channels(self, cvtype: int) -> tuple[str, int]:
        """numpy's type, and the number of channels, of OpenCV's type with this number."""
        return TYPES[_DEPTHS[cvtype & 7]], (cvtype >> 3) + 1

    def encoding_to_cvtype2(self, encoding: str) -> int:
        """The number of OpenCV's type for an encoding, 16 for "bgr8". Raises CvBridgeError if there is none."""
        if found := _COLOURS.fullmatch(encoding):
            depth, channels = f"{found[3]}U", 1 if found[1] else 4 if found[2] else 3
        elif found := _BAYER.fullmatch(encoding):
            depth, channels = f"{found[1]}U", 1
        elif found := _GENERIC.fullmatch(encoding):
            depth, channels = found[1], int(found[2])
        elif encoding in ("yuv422", "yuv422_yuy2"):
            depth, channels = "8U", 2
        else:
            raise CvBridgeError(f"Unrecognized image encoding [{encoding}]")
        return _DEPTHS.index(depth) + ((channels - 1) << 3)

    def encoding_to_dtype_with_channels(self, encoding: str) -> tuple[str, int]:
        """numpy's type, and the number of channels, of an encoding."""
        return self.cvtype2_to_dtype_with_channels(self.encoding_to_cvtype2(encoding))

    def imgmsg_to_cv2(self, img_msg: Image, desired_encoding: str = "passthrough") -> Array:
        """The image of a message, as it is encoded there or in another encoding.

        Raises CvBridgeError if there is no such encoding, or no way from one to the other.
        """
        kind, channels = self.encoding_to_dtype_with_channels(img_msg.encoding)
        dtype = np.dtype(kind).newbyteorder(">" if img_msg.is_bigendian else "<")
        columns = img_msg.step // (dtype.itemsize * channels) or img_msg.width
        shape = (img_msg.height, columns, channels) if channels > 1 else (img_msg.height, columns)
        image: Array = np.ndarray(shape, dtype, img_msg.data)[:, : img_msg.width]
        if img_msg.is_bigendian == (sys.byteorder == "little"):
            image = image.astype(dtype.newbyteorder("="))
        return image if desired_encoding == "passthrough" else self._convert(image, img_msg.encoding, desired_encoding)

    def cv2_to_imgmsg(self, cvim: Array, encoding: str = "passthrough", header: Any = None) -> Image:
        """The message for an image, which must be encoded as `encoding` says; "passthrough" names its type only.

        Raises TypeError if the image is no array, and CvBridgeError if the array's type cannot be that of the encoding.
        """
        _check_array(cvim)
        height, width, *rest = cvim.shape
        kind = self.dtype_with_channels_to_cvtype2(cvim.dtype, rest[0] if rest else 1)
        if encoding != "passthrough" and self.encoding_to_cvtype2(encoding) != self.encoding_to_cvtype2(kind):
            raise CvBridgeError(f"encoding specified as {encoding}, but image has incompatible type {kind}")
        message = Image(height=height, width=width, encoding=kind if encoding == "passthrough" else encoding)
        if header is not None:
            message.header = header
        message.is_bigendian = int(cvim.dtype.byteorder == ">")
        message.data = array("B", cvim.tobytes())
        message.step = len(message.data) // height if height else 0
        return message

    def _convert(self, image: Array, source: str, target: str) -> Array:
        """An image in another encoding."""
        if source == target:
            return image.copy()
        kind, channels = self.encoding_to_dtype_with_channels(target)
        same = channels == (image.shape[2] if image.ndim > 2 else 1)
        refusal = ""
        if not is_colour(source) and is_colour(target):
            refusal = f"[{source}] is not a color format. but [{target}] is. The conversion does not make sense"
        elif not is_colour(source) and not same:
            refusal = f"[{source}] and [{target}] do not have the same number of channel"
        elif not is_colour(target) and not same:
            types = "they must have the same OpenCV type, CV_8UC3, CV16UC1 ...."
            refusal = f"[{source}] is a color format but [{target}] is not so {types}"
        for encoding in (source, target):
            if is_colour(encoding) and not _COLOURS.fullmatch(encoding):
                others = (
                    "is available with OpenCV's own cv_bridge only; here rgb, bgr, rgba, bgra and mono can be converted"
                )
                refusal = refusal or f"[{encoding}] to or from other colours {others}"
        if refusal:
            raise CvBridgeError(refusal)
        if is_colour(source) and is_colour(target):
            image = _with_channels(image, _channels(source), _channels(target))
        return _with_depth(image, np.dtype(kind))

    def compressed_imgmsg_to_cv2(self, cmprs_img_msg: CompressedImage, desired_encoding: str = "passthrough") -> Array:
        """The image of a compressed message. Raises ImportError if OpenCV is not installed."""
        cv2 = _opencv()
        image: Array = cv2.imdecode(np.frombuffer(cmprs_img_msg.data, np.uint8), cv2.IMREAD_UNCHANGED)
        return image if desired_encoding == "passthrough" else self._convert(image, "bgr8", desired_encoding)

    def cv2_to_compressed_imgmsg(self, cvim: Array, dst_format: str = "jpg") -> CompressedImage:
        """The compressed message for an array; TypeError for what is none, ImportError if OpenCV is not installed."""
        _check_array(cvim)
        data = _opencv().imencode(f".{dst_format}", cvim)[1]
        return CompressedImage(format=dst_format, data=array("B", data.tobytes()))


def _check_array(image: object) -> None:
    if not isinstance(image, (np.ndarray, np.generic)):
        raise TypeError("Your input type is not a numpy array")


def _opencv() -> Any:
    try:
        return importlib.import_module("cv2")
    except ImportError:
        install = "pip install opencv-python (in a notebook: %pip install opencv-python)"
        raise ImportError(f"compressed images need OpenCV, which is not installed: {install}", name="cv2") from None


def is_colour(encoding: str) -> bool:
    """Whether an encoding says what its channels mean: grey, colours, a Bayer pattern; "8UC3" does not."""
    return encoding.startswith(("rgb", "bgr", "mono", "bayer_", "yuv422"))


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
    channels = {"a": np.full(image.shape[:2], np.iinfo(image.dtype).max, image.dtype)}
    channels |= dict.fromkeys("rgb", image) if source == "y" else {name: image[..., i] for i, name in enumerate(source)}
    return np.stack([channels[name] for name in target], axis=-1)


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
