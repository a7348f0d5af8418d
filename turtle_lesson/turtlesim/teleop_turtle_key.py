"""`ros2 run turtlesim turtle_teleop_key`: arrow keys drive the turtle, letters turn it to a direction of the compass.

The keys are pressed in `lesson.teleop()` or by `lesson.press`. Facts: ros_tutorials, turtlesim/tutorials/teleop_turtle_key.cpp.
"""

from __future__ import annotations

import threading
from typing import Any

import rclpy
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient
from rclpy.node import Node
from turtlesim.action import RotateAbsolute

from ..ros.runtime.world import current_process
from ..ros.stdlib.terminals import ProgramInput

HELP = """\
Reading from keyboard
---------------------------
Use arrow keys to move the turtle.
Use G|B|V|C|D|E|R|T keys to rotate to absolute orientations. 'F' to cancel a rotation.
'Q' to quit."""

SPEEDS = {"up": (1.0, 0.0), "down": (-1.0, 0.0), "left": (0.0, 1.0), "right": (0.0, -1.0)}
"""Forward and turning to the left, by the arrow key."""

HEADINGS = {
    "g": 0.0, "t": 0.7854, "r": 1.5708, "e": 2.3562, "d": 3.1416, "c": -2.3562, "v": -1.5708, "b": -0.7854,
}  # fmt: skip
"""Radians to turn to: the letters lie around F as the directions do."""


class TeleopTurtle(Node):
    """Does what the keys say."""

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


def main() -> None:
    """Read keys until q or Ctrl-C."""
    rclpy.init()
    node = TeleopTurtle()
    threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
    print(HELP)
    keyboard = ProgramInput(current_process())
    try:
        while (key := keyboard.next_key(None)) not in ("q", None):
            node.do(str(key))
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()
