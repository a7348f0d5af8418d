"""The simulated turtle, and what it shows to ROS, as it was when this benchmark was made; see `nodes.py`."""

from __future__ import annotations

import math
import struct
from collections import deque
from collections.abc import Callable
from typing import Any

from .messages import Color, Pose

TICK = 0.016
COMMAND_TICKS = 63
CELL = 3 / 45
CELLS_PER_METRE = 1 / CELL
PEN = (179, 184, 255)
BARE = (255, 255, 255)
PI = 3.14159265
TWO_PI = 2.0 * PI
HEIGHT: float = struct.unpack("f", struct.pack("f", 499 / 45))[0]
MIDDLE: float = struct.unpack("f", struct.pack("f", HEIGHT / 2))[0]


class Turtlesim:
    """The node: a timer moves the turtles and publishes."""

    def __init__(self) -> None:
        self.turtle = Turtle()
        self.shown = ShownTurtle(self.turtle)
        self._turtles, self._all_shown = {"turtle1": self.turtle}, {"turtle1": self.shown}

    def on_tick(self) -> None:
        """Move on by 16 ms, and publish."""
        hits = [hit for turtle in self._turtles.values() if (hit := turtle.tick()) is not None]
        if hits:
            raise RuntimeError("a frozen turtle knows no walls")
        for shown in self._all_shown.values():
            shown.publish()


class ShownTurtle:
    """What ROS sees of the turtle."""

    publish_pose: Callable[[Any], object]
    publish_colour: Callable[[Any], object]

    def __init__(self, turtle: Turtle) -> None:
        self._turtle = turtle
        self._pose, self._colour = Pose(), Color()
        self._colour_in_message = (0, 0, 0)

    def publish(self) -> None:
        """Publish the pose and the colour after a tick."""
        turtle = self._turtle
        if not turtle.at_rest:
            pose = self._pose
            pose.x = turtle.x
            pose.y = HEIGHT - turtle.flipped_y
            pose.theta = turtle.theta
            pose.linear_velocity = turtle.speed
            pose.angular_velocity = turtle.angular
        self.publish_pose(self._pose)
        if turtle.colour != self._colour_in_message:
            self._colour_in_message = turtle.colour
            self._colour.r, self._colour.g, self._colour.b = turtle.colour
        self.publish_colour(self._colour)

    def on_command(self, message: Any) -> None:
        """A command is heard."""
        self._turtle.command(message.linear.x, message.linear.y, message.angular.z)


class Turtle:
    """One turtle in the middle of its world."""

    def __init__(self) -> None:
        self.x, self.flipped_y, self.theta = MIDDLE, MIDDLE, 0.0
        self.colour = BARE
        self.cells: dict[int, tuple[int, int, int]] = {}
        self._cell = cell_at(self.x, self.flipped_y)
        self._commands: deque[tuple[float, float, float]] = deque(maxlen=7)
        self._stop()
        self.at_rest = self._stopped = False

    def command(self, forward: float, sideways: float, angular: float) -> None:
        """Drive at these speeds for the next 63 ticks."""
        if not (abs(forward) <= 1e38 and abs(sideways) <= 1e38 and abs(angular) <= 1e38):
            raise ValueError(f"not a command: {forward}, {sideways}, {angular}")
        self._commands.append((forward, sideways, angular))
        self._stopped = self.at_rest = False

    def tick(self) -> tuple[float, float] | None:
        """Move on by 16 ms. Returns where it would be, had a wall not held it up."""
        self.colour = self.cells.get(self._cell, BARE)
        if self.at_rest:
            return None
        if self._commands:
            self._forward, self._sideways, self.angular = self._commands.popleft()
            self.speed = math.sqrt(self._forward * self._forward + self._sideways * self._sideways)
            self._ticks_left = COMMAND_TICKS
        if self._ticks_left:
            self._ticks_left -= 1
        elif self._stopped:
            self.at_rest = True
            return None
        else:
            self._stop()
        return self._move()

    def _move(self) -> tuple[float, float] | None:
        theta = self.theta + self.angular * TICK
        if not -3.14 < theta < 3.14:
            theta -= TWO_PI * math.floor((theta + PI) / TWO_PI)
        self.theta = theta
        cos, sin = math.cos(theta), math.sin(theta)
        x = self.x + (cos * self._forward * TICK - sin * self._sideways * TICK)
        y = self.flipped_y - (cos * self._sideways * TICK + sin * self._forward * TICK)
        if not (0.0 <= x <= HEIGHT and 0.0 <= y <= HEIGHT):
            return x, y
        if x != self.x or y != self.flipped_y:
            self._cell = cell_at(x, y)
            self.cells[self._cell] = PEN
            self.x, self.flipped_y = x, y
        return None

    def _stop(self) -> None:
        self._forward = self._sideways = self.speed = self.angular = 0.0
        self._ticks_left = 0
        self._stopped = True


def cell_at(x: float, y: float) -> int:
    """The number of the cell of the canvas that holds a point, in metres."""
    return int(x * CELLS_PER_METRE) * 1024 + int(y * CELLS_PER_METRE)
