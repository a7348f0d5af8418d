"""cv_bridge without OpenCV: images as messages and as arrays of numpy, and from one encoding to another."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest
from cv_bridge import CvBridge, CvBridgeError
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

BRIDGE = CvBridge()
RED, GREY, BLUE = (255, 0, 0), (100, 100, 100), (10, 20, 250)
RGB = np.array([[RED, GREY, BLUE]], np.uint8)


@pytest.mark.parametrize(
    ("dtype", "shape", "encoding"),
    [
        ("uint8", (4, 6, 3), "8UC3"), ("uint8", (4, 6), "8UC1"), ("uint16", (4, 6), "16UC1"), ("float32", (4, 6), "32FC1"),
        ("float64", (4, 6, 2), "64FC2"), ("int16", (4, 6, 4), "16SC4"), ("int32", (4, 6), "32SC1"),
        ("uint8", (2, 3, 7), "8UC7"),
    ],
)  # fmt: skip
def test_an_array_becomes_a_message_and_an_array_again(dtype: str, shape: tuple[int, ...], encoding: str) -> None:
    image = np.arange(np.prod(shape)).reshape(shape).astype(dtype)
    message = BRIDGE.cv2_to_imgmsg(image)
    assert isinstance(message, Image)
    assert (message.height, message.width, message.encoding) == (*shape[:2], encoding)
    assert message.step * message.height == len(message.data) == image.nbytes
    again = BRIDGE.imgmsg_to_cv2(message)
    assert again.dtype == dtype and np.array_equal(again, image) and not again.flags.owndata  # as in the real one
    again[0, 0] = 1  # it can be drawn into


def test_an_encoding_and_a_header_are_kept() -> None:
    message = BRIDGE.cv2_to_imgmsg(RGB, "rgb8", header=Header(frame_id="camera"))
    assert (message.encoding, message.header.frame_id, message.step) == ("rgb8", "camera", 9)
    assert np.array_equal(BRIDGE.imgmsg_to_cv2(message, "rgb8"), RGB)


@pytest.mark.parametrize(
    ("target", "pixels"),
    [
        ("bgr8", [(0, 0, 255), GREY, (250, 20, 10)]),
        ("rgba8", [(255, 0, 0, 255), (100, 100, 100, 255), (10, 20, 250, 255)]),
        ("bgra8", [(0, 0, 255, 255), (100, 100, 100, 255), (250, 20, 10, 255)]),
        ("mono8", [76, 100, 43]),
        ("8UC3", [RED, GREY, BLUE]),
        ("32FC3", [RED, GREY, BLUE]),
    ],
)
def test_colours_are_converted(target: str, pixels: list[Any]) -> None:
    image = BRIDGE.imgmsg_to_cv2(BRIDGE.cv2_to_imgmsg(RGB, "rgb8"), desired_encoding=target)
    assert image[0].tolist() == [list(pixel) if isinstance(pixel, tuple) else pixel for pixel in pixels]
    assert image.dtype == ("float32" if target == "32FC3" else "uint8")


def test_grey_becomes_a_colour_and_so_do_sixteen_bits() -> None:
    message = BRIDGE.cv2_to_imgmsg(np.array([[0, 1000, 65535]], np.uint16), "mono16")
    assert BRIDGE.imgmsg_to_cv2(message, "bgr16")[0].tolist() == [[0] * 3, [1000] * 3, [65535] * 3]
    alpha = BRIDGE.cv2_to_imgmsg(np.array([[(1, 2, 3, 4)]], np.uint8), "bgra8")
    assert BRIDGE.imgmsg_to_cv2(alpha, "rgba8").tolist() == [[[3, 2, 1, 4]]]


def test_rows_with_gaps_and_numbers_with_the_high_byte_first() -> None:
    message = Image(height=2, width=2, encoding="mono8", step=4, data=[1, 2, 0, 0, 3, 4, 0, 0])
    assert BRIDGE.imgmsg_to_cv2(message).tolist() == [[1, 2], [3, 4]]
    message = BRIDGE.cv2_to_imgmsg(np.array([[1, 256]], ">u2"))
    assert (message.is_bigendian, list(message.data)) == (1, [0, 1, 1, 0])
    assert BRIDGE.imgmsg_to_cv2(message).tolist() == [[1, 256]]


@pytest.mark.parametrize(
    ("source", "target", "text"),
    [
        ("16UC1", "bgr8", r"\[16UC1\] is not a color format. but \[bgr8\] is. The conversion does not make sense"),
        ("16UC1", "16UC2", r"\[16UC1\] and \[16UC2\] do not have the same number of channel"),
        ("mono16", "8UC3", r"\[mono16\] and \[8UC3\] do not have the same number of channel"),
        ("mono16", "bgr9", r"Unrecognized image encoding \[bgr9\]"),
        ("mono16", "9UC1", r"Unrecognized image encoding \[9UC1\]"),
        ("mono16", "mono8", r"8 to 16 bits and back is available with OpenCV's cv_bridge only"),
    ],
)
def test_what_has_no_meaning_is_refused(source: str, target: str, text: str) -> None:
    message = BRIDGE.cv2_to_imgmsg(np.zeros((2, 2), np.uint16), source)
    with pytest.raises(CvBridgeError, match=text):
        BRIDGE.imgmsg_to_cv2(message, target)


def test_what_is_no_image_of_the_encoding_is_refused() -> None:
    with pytest.raises(CvBridgeError, match="encoding specified as mono8, but image has incompatible type 8UC3"):
        BRIDGE.cv2_to_imgmsg(RGB, "mono8")
    with pytest.raises(CvBridgeError, match="OpenCV has no images of the type bool: convert it"):
        BRIDGE.cv2_to_imgmsg(RGB > 1)
    with pytest.raises(TypeError, match="Your input type is not a numpy array"):
        BRIDGE.cv2_to_imgmsg([[1]])


def test_compressed_images_need_opencv(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    for call in (
        lambda: BRIDGE.compressed_imgmsg_to_cv2(CompressedImage()),
        lambda: BRIDGE.cv2_to_compressed_imgmsg(RGB),
    ):
        with pytest.raises(ImportError, match="cv2"):
            call()


def test_compressed_images_with_opencv() -> None:
    pytest.importorskip("cv2")
    message = BRIDGE.cv2_to_compressed_imgmsg(RGB[..., ::-1].copy(), "png")
    assert np.array_equal(BRIDGE.compressed_imgmsg_to_cv2(message, "rgb8"), RGB)
