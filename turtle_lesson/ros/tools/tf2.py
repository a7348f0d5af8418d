"""Programs about frames: `ros2 run tf2_ros tf2_echo`, `static_transform_publisher`, `tf2_tools view_frames`.

Facts: geometry2, tf2_ros/src/tf2_echo.cpp (Humble), static_transform_broadcaster_program.cpp and …_node.cpp,
and tf2_tools/tf2_tools/view_frames.py, which writes a PDF.
"""

from __future__ import annotations

import argparse
import math
import random
import re
import string
import sys
import time

import rclpy
import yaml
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3
from rclpy.executors import ExternalShutdownException
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.node import Node
from rclpy.time import Time
from rclpy.utilities import remove_ros_args
from rosidl_runtime_py import message_to_ordereddict
from tf2_py._rotation import matrix_of
from tf2_ros import Buffer, StaticTransformBroadcaster, TransformListener
from tf_transformations import euler_from_matrix, quaternion_from_euler

from . import spin


class Echo(Node):
    """Prints the latest transform between two frames, at a rate (Hz)."""

    def __init__(self, source: str, target: str, rate: float) -> None:
        super().__init__("tf2_echo")
        self._source, self._target = source, target
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self.create_timer(1.0 / rate, self.look)
        self.look()

    def look(self) -> None:
        """Look once, and print what is there."""
        asked = (self._source, self._target, Time())
        found, why_not = self._buffer.can_transform(*asked, return_debug_tuple=True)
        if found:
            print(text_of(self._buffer.lookup_transform(*asked)))
        else:
            self.get_logger().info(f"Waiting for transform {self._source} ->  {self._target}: {why_not}")


def text_of(transform: TransformStamped) -> str:
    """A transform in figures: shift, quaternion, angles and matrix."""
    stamp, shift, turn = transform.header.stamp, transform.transform.translation, transform.transform.rotation
    quaternion = (turn.x, turn.y, turn.z, turn.w)
    matrix = matrix_of(quaternion)
    angles = euler_from_matrix(matrix)
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


def tf2_echo() -> int:
    """`tf2_echo A B [RATE]`: where frame B is, seen from frame A, again and again until Ctrl-C."""
    about = "Print the transform that data in target_frame needs to be in source_frame: where target_frame is, seen from there"
    parser = argparse.ArgumentParser(prog="tf2_echo", description=about)
    parser.add_argument("source_frame")
    parser.add_argument("target_frame")
    parser.add_argument("echo_rate", nargs="?", type=float, default=1.0, help="how often a second (default: 1)")
    args = parser.parse_args(remove_ros_args(sys.argv)[1:])
    if not 0.0 < args.echo_rate <= 1000.0:
        parser.error(f"the rate must be more than 0 and at most 1000 Hz, got {args.echo_rate:g}")
    return spin(lambda: Echo(args.source_frame, args.target_frame, args.echo_rate))


# -- view_frames -------------------------------------------------------------------------------------------------------


def tree_of(frames: dict[str, dict[str, str]]) -> str:
    """The frames as a tree, each under its parent, with what is known of it. `frames`: as `all_frames_as_yaml`."""
    lines: list[str] = []

    def draw_below(parent: str, indent: str) -> None:
        names = [name for name, entry in frames.items() if entry["parent"] == parent]
        for name in names:
            sign, more = ("└── ", "    ") if name == names[-1] else ("├── ", "│   ")
            rate, latest = (float(frames[name][key]) for key in ("rate", "most_recent_transform"))
            known = f"{rate:.1f} Hz, the latest at {latest:.3f}" if latest else "static"
            lines.append(f"{indent}{sign}{name}  ({known})")
            draw_below(name, indent + more)

    for root in dict.fromkeys(entry["parent"] for entry in frames.values() if entry["parent"] not in frames):
        lines.append(root)
        draw_below(root, "")
    return "\n".join(lines)


def view_frames() -> int:
    """`view_frames`: listens for five seconds, and draws the tree of frames, here as text."""
    parser = argparse.ArgumentParser(prog="view_frames", description="Draw the tree of frames that are told on /tf")
    parser.add_argument("--wait-time", "-t", type=float, default=5.0, help="for how many seconds to listen first")
    parser.add_argument("-o", "--output", help="name of the file: accepted, and without effect here")
    wait = parser.parse_args(remove_ros_args(sys.argv)[1:]).wait_time
    rclpy.init()
    node = Node("view_frames")
    buffer = Buffer(node=node)
    TransformListener(buffer, node)
    node.get_logger().info(f"Listening to tf data for {wait} seconds...")
    end = time.time() + wait
    try:
        while time.time() < end:
            rclpy.spin_once(node, timeout_sec=0.1)
    except (KeyboardInterrupt, ExternalShutdownException):
        return 1
    node.get_logger().info("Generating graph...")
    frames = yaml.load(buffer.all_frames_as_yaml(), yaml.BaseLoader)  # texts, as a frame may be called 1
    print(tree_of(frames) if frames else "No tf data received: no node publishes on /tf or /tf_static.")
    rclpy.try_shutdown()
    return 0


# -- static_transform_publisher ----------------------------------------------------------------------------------------

SHIFT, ANGLES, TURN = ("x", "y", "z"), ("roll", "pitch", "yaw"), ("qx", "qy", "qz", "qw")
FRAMES = ("frame-id", "child-frame-id")
OLD_STYLE = {8: (*SHIFT, "yaw", "pitch", "roll", *FRAMES), 9: (*SHIFT, *TURN, *FRAMES)}
"""What older releases took without flags, by how many words there are."""


def read_words(words: list[str]) -> TransformStamped:
    """The transform that the words of a command line name. Raises SystemExit, with what is wrong."""
    about = (
        "Publish a frame that never moves: where child-frame-id is, seen from frame-id. What is left out is 0, no turn."
    )
    parser = argparse.ArgumentParser(prog="static_transform_publisher", description=about)
    for name in SHIFT:
        parser.add_argument(f"--{name}", type=float, default=0.0, help="in m")
    for name in (*ANGLES, *TURN):
        parser.add_argument(f"--{name}", type=float, help="in rad" if name in ANGLES else "part of a quaternion")
    for name in FRAMES:
        parser.add_argument(f"--{name}", required=True)
    if len(words) in OLD_STYLE and not any(word.startswith("--") for word in words):
        RcutilsLogger("").warning("Old-style arguments are deprecated; see --help for new-style arguments")
        words = [f"--{name}={word}" for name, word in zip(OLD_STYLE[len(words)], words, strict=True)]
    # A space before it keeps argparse from taking -1e-3 for a flag.
    args = parser.parse_args([f" {word}" if re.match(r"-[\d.]", word) else word for word in words])
    angles, turn = ([getattr(args, name) for name in names] for names in (ANGLES, TURN))
    if any(angle is not None for angle in angles) and any(part is not None for part in turn):
        parser.error("Cannot specify both quaternion and Euler rotations")
    if args.frame_id == args.child_frame_id:
        ends = f"from '{args.frame_id}' to '{args.child_frame_id}'"
        parser.error(f"cannot publish static transform {ends}: child_frame_id cannot equal frame_id")
    if any(part is not None for part in turn):
        rotation = [default if part is None else part for part, default in zip(turn, (0.0, 0.0, 0.0, 1.0), strict=True)]
    else:
        roll, pitch, yaw = (angle or 0.0 for angle in angles)
        rotation = [*quaternion_from_euler(roll, pitch, yaw)]
    message = TransformStamped(child_frame_id=args.child_frame_id)
    message.header.frame_id = args.frame_id
    message.transform.translation = Vector3(x=args.x, y=args.y, z=args.z)
    message.transform.rotation = Quaternion(**dict(zip("xyzw", rotation, strict=True)))
    return message


class StaticPublisher(Node):
    """Tells of one frame."""

    def __init__(self, message: TransformStamped) -> None:
        letters = "".join(random.choice(string.ascii_letters + string.digits) for _ in range(16))
        super().__init__(f"static_transform_publisher_{letters}")
        self._broadcaster = StaticTransformBroadcaster(self)
        message.header.stamp = self.get_clock().now().to_msg()
        self._broadcaster.sendTransform(message)
        figures = message_to_ordereddict(message.transform)
        translation, rotation = (", ".join(f"'{value:f}'" for value in axes.values()) for axes in figures.values())
        told = f"translation: ({translation})\nrotation: ({rotation})\n"
        told += f"from '{message.header.frame_id}' to '{message.child_frame_id}'"
        self.get_logger().info(f"Spinning until stopped - publishing transform\n{told}")


def static_transform_publisher() -> int:
    """`static_transform_publisher --x 1 --frame-id A --child-frame-id B`, and the older way, until Ctrl-C."""
    message = read_words(remove_ros_args(sys.argv)[1:])
    return spin(lambda: StaticPublisher(message))
