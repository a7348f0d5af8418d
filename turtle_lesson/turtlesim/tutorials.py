"""The other programs of turtlesim: `ros2 run turtlesim draw_square`, `mimic` and `turtle_teleop_key`, in plain ``rclpy``.

Facts: ros_tutorials, turtlesim/tutorials/draw_square.cpp of Kilted and newer (Humble's has a mistake: it stops after its first
goal, which it reckons from (0, 0)), mimic.cpp and teleop_turtle_key.cpp.
"""

from __future__ import annotations

import math
import threading
from contextlib import suppress
from functools import partial
from typing import Any

import rclpy
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient
from rclpy.node import Node
from std_srvs.srv import Empty
from turtlesim.action import RotateAbsolute
from turtlesim.msg import Pose

from ..ros.runtime.world import current_process
from ..ros.stdlib.terminals import ProgramInput
from ..ros.tools import spin

PERIOD = 0.016
SIDE = 2.0
SPEED, TURN_SPEED = 1.0, 0.4
NEAR, ALIGNED, STILL = 0.1, 0.01, 0.0001


class DrawSquare(Node):
    """The turtle walks along a square, one side after the other, driven by what is heard of its pose."""

    def __init__(self) -> None:
        super().__init__("draw_square")
        self._pose: Pose | None = None
        self._goal: Pose | None = None
        self._turning = self._stopping = False
        self._publisher = self.create_publisher(Twist, "turtle1/cmd_vel", 1)
        self.create_subscription(Pose, "turtle1/pose", self._on_pose, 1)
        self.create_timer(PERIOD, self._step)
        self.create_client(Empty, "reset").call_async(Empty.Request())

    def _on_pose(self, pose: Pose) -> None:
        self._pose = pose

    def _step(self) -> None:
        pose = self._pose
        if pose is None:
            return
        goal = self._goal or self._aim(pose)
        command = Twist()
        if self._stopping:
            if pose.angular_velocity < STILL and pose.linear_velocity < STILL:
                self.get_logger().info("Reached goal")
                self._turning, self._stopping = not self._turning, False
                self._aim(pose)
                return
        else:
            near = abs(pose.x - goal.x) < NEAR and abs(pose.y - goal.y) < NEAR
            self._stopping = near and abs(math.remainder(pose.theta - goal.theta, 2.0 * math.pi)) < ALIGNED
            if not self._stopping and self._turning:
                command.angular.z = TURN_SPEED
            elif not self._stopping:
                command.linear.x = SPEED
        self._publisher.publish(command)

    def _aim(self, pose: Pose) -> Pose:
        """The next goal: a quarter turn to the left, or a side ahead."""
        if self._turning:
            goal = Pose(x=pose.x, y=pose.y, theta=math.remainder(pose.theta + math.pi / 2.0, 2.0 * math.pi))
        else:
            x, y = pose.x + SIDE * math.cos(pose.theta), pose.y + SIDE * math.sin(pose.theta)
            goal = Pose(x=x, y=y, theta=pose.theta)
        self.get_logger().info(f"New goal [{goal.x:f} {goal.y:f}, {goal.theta:f}]")
        self._goal = goal
        return goal


class Mimic(Node):
    """One turtle does what another one does: passes the speeds of its pose on as a command.

    `ros2 run turtlesim mimic --ros-args -r input/pose:=turtle1/pose -r output/cmd_vel:=turtle2/cmd_vel`
    """

    def __init__(self) -> None:
        super().__init__("turtle_mimic")
        self._publisher = self.create_publisher(Twist, "output/cmd_vel", 1)
        self.create_subscription(Pose, "input/pose", self._on_pose, 1)

    def _on_pose(self, pose: Pose) -> None:
        message = Twist()
        message.linear.x, message.angular.z = pose.linear_velocity, pose.angular_velocity
        self._publisher.publish(message)


draw_square = partial(spin, DrawSquare)
mimic = partial(spin, Mimic)

HELP = """\
Reading from keyboard
---------------------------
Use arrow keys to move the turtle.
Use G|B|V|C|D|E|R|T keys to rotate to absolute orientations. 'F' to cancel a rotation.
'Q' to quit."""

SPEEDS = {"\x1b[A": (1.0, 0.0), "\x1b[B": (-1.0, 0.0), "\x1b[D": (0.0, 1.0), "\x1b[C": (0.0, -1.0)}
"""Forward and turning to the left, by what a terminal sends for an arrow key: up, down, left, right."""

HEADINGS = {
    "g": 0.0, "t": 0.7854, "r": 1.5708, "e": 2.3562, "d": 3.1416, "c": -2.3562, "v": -1.5708, "b": -0.7854,
}  # fmt: skip
"""Radians to turn to: the letters lie around F as the directions do."""


class TeleopTurtle(Node):
    """Arrow keys drive the turtle, letters turn it to a direction of the compass.

    The keys are pressed in `lesson.teleop()` or by `lesson.press`.
    """

    def __init__(self) -> None:
        super().__init__("teleop_turtle")
        self._forward: float = self.declare_parameter("scale_linear", 2.0).value
        self._turn: float = self.declare_parameter("scale_angular", 2.0).value
        self._publisher = self.create_publisher(Twist, "turtle1/cmd_vel", 1)
        self._client = ActionClient(self, RotateAbsolute, "turtle1/rotate_absolute")
        self._goal: Any = None

    def do(self, key: str) -> None:
        """Carry out a key: drive, turn, or cancel the turn."""
        if key in SPEEDS:
            forward, turn = SPEEDS[key]
            message = Twist()
            message.linear.x, message.angular.z = self._forward * forward, self._turn * turn
            self._publisher.publish(message)
        elif key in HEADINGS:
            future = self._client.send_goal_async(RotateAbsolute.Goal(theta=HEADINGS[key]))
            future.add_done_callback(self._on_response)
        elif key == "f" and self._goal is not None:
            self._goal.cancel_goal_async()

    def _on_response(self, future: Any) -> None:
        self._goal = future.result()


def turtle_teleop_key() -> None:
    """Read keys until q or Ctrl-C."""
    rclpy.init()
    node = TeleopTurtle()
    threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
    print(HELP)
    keyboard = ProgramInput(current_process())
    keyboard.raw = True
    with suppress(KeyboardInterrupt):
        while (key := keyboard.read(1)) not in ("q", ""):
            node.do(key + keyboard.take(2) if key == "\x1b" else key)
    rclpy.try_shutdown()
