"""`ros2 run tf2_ros static_transform_publisher --x 1 --yaw 1.57 --frame-id A --child-frame-id B`, and the older way.

Facts: geometry2, tf2_ros/src/static_transform_broadcaster_program.cpp and …_node.cpp.
"""

from __future__ import annotations

import random
import string
import sys
from contextlib import suppress

import rclpy
from geometry_msgs.msg import TransformStamped
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.executors import ExternalShutdownException
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.utilities import remove_ros_args
from tf2_py._rotation import turn_from_angles
from tf2_ros import StaticTransformBroadcaster

USAGE = """\
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


class Publisher(Node):
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


def main() -> int:
    """Run until Ctrl-C."""
    words = remove_ros_args(sys.argv)[1:]
    rclpy.init()
    if "--help" in words or "-h" in words:
        print(USAGE)
        return 0
    try:
        values = parameters_of(read_words(words))
    except UsageError as error:
        RcutilsLogger("").error(f"error parsing command line arguments: {error}")
        print(USAGE)
        return 1
    ends = f"from '{values['frame_id']}' to '{values['child_frame_id']}'"
    if values["frame_id"] == values["child_frame_id"]:
        RcutilsLogger("").error(f"cannot publish static transform {ends}: child_frame_id cannot equal frame_id")
        return 1
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        node = Publisher(values)
        shift, turn = (
            ", ".join(f"'{value:f}'" for name, value in values.items() if name.startswith(part))
            for part in ("translation", "rotation")
        )
        told = f"translation: ({shift})\nrotation: ({turn})\n{ends}"
        node.get_logger().info(f"Spinning until stopped - publishing transform\n{told}")
        rclpy.spin(node)
    return 0
