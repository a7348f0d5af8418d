"""`ros2 run tf2_ros tf2_echo A B [RATE]`: where frame B is, seen from frame A, again and again.

Facts: geometry2, tf2_ros/src/tf2_echo.cpp (Humble).
"""

from __future__ import annotations

import math
import sys
from contextlib import suppress

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.time import Time
from rclpy.utilities import remove_ros_args
from tf2_py import _rotation as turns
from tf2_ros import Buffer, TransformException, TransformListener

USAGE = """\
Usage: tf2_echo source_frame target_frame [echo_rate]

Prints where target_frame is, seen from source_frame: the transform that data in target_frame
needs to be in source_frame. The echo rate is in Hz; 1 if it is left out."""


class Echo(Node):
    """Prints the latest transform between two frames, at a rate (Hz)."""

    def __init__(self, source: str, target: str, rate: float) -> None:
        super().__init__("tf2_echo")
        self._source, self._target = source, target
        self._found = False
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self.create_timer(1.0 / rate, self.look)
        self.look()

    def look(self) -> None:
        """Look once, and print what is there."""
        if not self._found:
            asked = (self._source, self._target, Time())
            self._found, why_not = self._buffer.can_transform(*asked, return_debug_tuple=True)
            if not self._found:
                self.get_logger().info(f"Waiting for transform {self._source} ->  {self._target}: {why_not}")
                return
        try:
            print(text_of(self._buffer.lookup_transform(self._source, self._target, Time())))
        except TransformException as error:
            now = self.get_clock().now().nanoseconds / 1e9
            print(f"Failure at {now:.6f}\nException thrown:{error}\nThe current list of frames is:")
            print(self._buffer.all_frames_as_string())


def text_of(transform: TransformStamped) -> str:
    """A transform in figures: shift, quaternion, angles and matrix."""
    stamp, shift, turn = transform.header.stamp, transform.transform.translation, transform.transform.rotation
    quaternion = (turn.x, turn.y, turn.z, turn.w)
    matrix = turns.matrix_of(quaternion)
    angles = turns.roll_pitch_yaw(matrix)
    place = (shift.x, shift.y, shift.z)
    rows = [(*row, there) for row, there in zip(matrix, place, strict=True)]
    return "\n".join(
        (
            f"At time {stamp.sec}.{stamp.nanosec:09d}" if stamp.sec else "At time 0.0",
            f"- Translation: {_listed(place)}",
            f"- Rotation: in Quaternion {_listed(quaternion)}",
            f"- Rotation: in RPY (radian) {_listed(angles)}",
            f"- Rotation: in RPY (degree) {_listed([math.degrees(angle) for angle in angles])}",
            "- Matrix:",
            *("".join(f" {number:6.3f}" for number in row) for row in [*rows, (0.0, 0.0, 0.0, 1.0)]),
        )
    )


def _listed(numbers: tuple[float, ...] | list[float]) -> str:
    return f"[{', '.join(f'{number:.3f}' for number in numbers)}]"


def main() -> int:
    """Run until Ctrl-C."""
    words = remove_ros_args(sys.argv)[1:]
    if len(words) not in (2, 3):
        print(USAGE)
        return 1
    rate = 1.0
    if len(words) == 3:
        try:
            rate = float(words[2])
        except ValueError:
            print(f"Failed to convert rate argument '{words[2]}' to a floating-point number", file=sys.stderr)
            return 2
    if not 0.0 < rate <= 1000.0:
        print(f"The rate must be more than 0 and at most 1000 Hz, got {words[2]}", file=sys.stderr)
        return 2
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Echo(words[0], words[1], rate))
    return 0
