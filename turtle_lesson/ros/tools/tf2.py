"""Programs about frames: `ros2 run tf2_ros tf2_echo`, `static_transform_publisher`, `tf2_tools view_frames`.

Facts: geometry2, tf2_ros/src/tf2_echo.cpp (Humble), static_transform_broadcaster_program.cpp and …_node.cpp,
and tf2_tools/tf2_tools/view_frames.py, which writes a PDF.
"""

from __future__ import annotations

import argparse
import math
import random
import string
import sys
import time
from typing import Any

import rclpy
import yaml
from geometry_msgs.msg import TransformStamped
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.executors import ExternalShutdownException
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.time import Time
from rclpy.utilities import remove_ros_args
from tf2_py._rotation import matrix_of, roll_pitch_yaw, turn_from_angles
from tf2_ros import Buffer, StaticTransformBroadcaster, TransformException, TransformListener

from . import spin

ECHO_USAGE = """\
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
    matrix = matrix_of(quaternion)
    angles = roll_pitch_yaw(matrix)
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
    words = remove_ros_args(sys.argv)[1:]
    if len(words) not in (2, 3):
        print(ECHO_USAGE)
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
    return spin(lambda: Echo(words[0], words[1], rate))


# -- view_frames -------------------------------------------------------------------------------------------------------


def tree_of(frames: dict[str, Any]) -> str:
    """The frames as a tree, each under its parent, with what is known of it. `frames`: as `all_frames_as_yaml`."""
    children: dict[str, list[str]] = {}
    for name, entry in frames.items():
        children.setdefault(entry["parent"], []).append(str(name))
    roots = [parent for parent in children if parent not in frames]
    return "\n".join(line for root in roots for line in [root, *_branches(root, children, frames, "")])


def _branches(parent: str, children: dict[str, list[str]], frames: dict[str, Any], indent: str) -> list[str]:
    lines = []
    names = children.get(parent, [])
    for name in names:
        sign, more = ("└── ", "    ") if name == names[-1] else ("├── ", "│   ")
        lines.append(f"{indent}{sign}{name}  ({_told(frames[name])})")
        lines += _branches(name, children, frames, indent + more)
    return lines


def _told(entry: dict[str, Any]) -> str:
    if not entry["most_recent_transform"]:
        return "static"
    return f"{entry['rate']:.1f} Hz, the latest at {entry['most_recent_transform']:.3f}"


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
    frames = yaml.safe_load(buffer.all_frames_as_yaml()) or {}
    print(tree_of(frames) if frames else "No tf data received: no node publishes on /tf or /tf_static.")
    rclpy.try_shutdown()
    return 0


# -- static_transform_publisher ----------------------------------------------------------------------------------------

PUBLISHER_USAGE = """\
usage: static_transform_publisher [--x X] [--y Y] [--z Z] [--qx QX] [--qy QY] [--qz QZ] [--qw QW]
                                  [--roll ROLL] [--pitch PITCH] [--yaw YAW]
                                  --frame-id FRAME_ID --child-frame-id CHILD_FRAME_ID

Publishes a frame that never moves: where child-frame-id is, seen from frame-id. Lengths are in m; the turn is
given by angles in rad or by a quaternion. What is left out is 0, no turn."""
SHIFT, ANGLES, TURN = ("x", "y", "z"), ("roll", "pitch", "yaw"), ("qx", "qy", "qz", "qw")
FRAMES = ("frame-id", "child-frame-id")
OLD_WITH_ANGLES = (*SHIFT, "yaw", "pitch", "roll", *FRAMES)
OLD_WITH_QUATERNION = (*SHIFT, *TURN, *FRAMES)


class UsageError(Exception):
    """What was typed cannot be understood."""


def read_words(words: list[str]) -> dict[str, str]:
    """The options that were typed, by name. Raises UsageError."""
    given: dict[str, str] = {}
    rest: list[str] = []
    waiting = iter(words)
    for word in waiting:
        name = word.removeprefix("--")
        if word.startswith("--") and name in (*SHIFT, *ANGLES, *TURN, *FRAMES):
            given[name] = next(waiting, "")
            if not given[name]:
                raise UsageError(f"Not enough arguments for {word}")
        else:
            rest.append(word)
    if not rest:
        return given
    names = {8: OLD_WITH_ANGLES, 9: OLD_WITH_QUATERNION}.get(len(rest))
    if names is None:
        raise UsageError("Extra unparsed arguments on command-line")
    RcutilsLogger("").warning("Old-style arguments are deprecated; see --help for new-style arguments")
    if given:
        raise UsageError("Cannot specify both new-style (flags) and old-style (arguments)")
    return dict(zip(names, rest, strict=True))


def parameters_of(given: dict[str, str]) -> dict[str, object]:
    """What the node's parameters shall be. Raises UsageError."""
    numbers = {name: _number(name, value) for name, value in given.items() if name not in FRAMES}
    if any(name in numbers for name in ANGLES) and any(name in numbers for name in TURN):
        raise UsageError("Cannot specify both quaternion and Euler rotations")
    turn = tuple(numbers.get(name, 1.0 if name == "qw" else 0.0) for name in TURN)
    if any(name in numbers for name in ANGLES):
        turn = turn_from_angles(*(numbers.get(name, 0.0) for name in ANGLES))
    for name, what in zip(FRAMES, ("Frame", "Child frame"), strict=True):
        if not given.get(name):
            raise UsageError(f"{what} id must not be empty")
    return {
        **{f"translation.{name}": numbers.get(name, 0.0) for name in SHIFT},
        **{f"rotation.{name}": value for name, value in zip("xyzw", turn, strict=True)},
        "frame_id": given["frame-id"],
        "child_frame_id": given["child-frame-id"],
    }


def _number(name: str, value: str) -> float:
    try:
        return float(value)
    except ValueError:
        raise UsageError(f"Failed to parse --{name} argument as float") from None


class StaticPublisher(Node):
    """Tells of one frame; its figures are parameters that can only be read."""

    def __init__(self, parameters: dict[str, object]) -> None:
        letters = "".join(random.choice(string.ascii_letters + string.digits) for _ in range(16))
        overrides = [Parameter(name, value=value) for name, value in parameters.items()]
        super().__init__(f"static_transform_publisher_{letters}", parameter_overrides=overrides)
        read_only = ParameterDescriptor(read_only=True)
        for name, value in parameters.items():
            self.declare_parameter(name, value, read_only)
        self._broadcaster = StaticTransformBroadcaster(self)
        message = TransformStamped(child_frame_id=parameters["child_frame_id"])
        message.header.frame_id = parameters["frame_id"]
        message.header.stamp = self.get_clock().now().to_msg()
        for name, value in parameters.items():
            part, _, axis = name.partition(".")
            if axis:
                setattr(getattr(message.transform, part), axis, value)
        self._broadcaster.sendTransform(message)
        shift, turn = (
            ", ".join(f"'{value:f}'" for name, value in parameters.items() if name.startswith(part))
            for part in ("translation", "rotation")
        )
        ends = f"from '{parameters['frame_id']}' to '{parameters['child_frame_id']}'"
        told = f"translation: ({shift})\nrotation: ({turn})\n{ends}"
        self.get_logger().info(f"Spinning until stopped - publishing transform\n{told}")


def static_transform_publisher() -> int:
    """`static_transform_publisher --x 1 --frame-id A --child-frame-id B`, and the older way, until Ctrl-C."""
    words = remove_ros_args(sys.argv)[1:]
    rclpy.init()
    if "--help" in words or "-h" in words:
        print(PUBLISHER_USAGE)
        return 0
    try:
        values = parameters_of(read_words(words))
    except UsageError as error:
        RcutilsLogger("").error(f"error parsing command line arguments: {error}")
        print(PUBLISHER_USAGE)
        return 1
    ends = f"from '{values['frame_id']}' to '{values['child_frame_id']}'"
    if values["frame_id"] == values["child_frame_id"]:
        RcutilsLogger("").error(f"cannot publish static transform {ends}: child_frame_id cannot equal frame_id")
        return 1
    return spin(lambda: StaticPublisher(values))
