"""All turtles of a simulation, and what may be done to them. No ROS in here.

The texts of the errors are the real turtlesim's log lines where it has one. It is kinder in one case: a name
that cannot be part of a topic's name ends the real program, and is refused here.
"""

import re
from itertools import count
from typing import NamedTuple

from .turtle import HEIGHT, LARGEST, WIDTH, Canvas, Turtle, TurtleError, float32

_NAME = re.compile(r"/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")


class WallHit(NamedTuple):
    """A turtle that a wall held up in this tick, and where it would have been (m; y flipped: from the upper wall)."""

    turtle: Turtle
    x: float
    flipped_y: float


class TurtleWorld:
    """Turtles in the order in which they were spawned, on one canvas, in a world of 11.088889 m by 11.088889 m."""

    def __init__(self) -> None:
        self.turtles: dict[str, Turtle] = {}
        self.canvas = Canvas()
        self._last_number = 0
        self.spawn_in_the_middle()

    def tick(self) -> list[WallHit]:
        """Move all turtles on by 16 ms. Returns those that hit a wall."""
        canvas = self.canvas
        return [WallHit(turtle, *at) for turtle in self.turtles.values() if (at := turtle.tick(canvas)) is not None]

    def spawn_in_the_middle(self) -> Turtle:
        """Add a turtle in the middle of the world, facing +x, with the next automatic name."""
        return self.spawn(WIDTH / 2, HEIGHT / 2, 0.0)

    def spawn(self, x: float, y: float, theta: float, name: str = "") -> Turtle:
        """Add a turtle at (x, y) in metres, heading theta in radians; a place beyond a wall is moved to the wall.

        Without a name it gets the next free one: turtle1, turtle2, and so on. Raises TurtleError if the name is taken or
        cannot be part of a topic's name, or if the place is no finite number.
        """
        if not (abs(x) <= LARGEST and abs(y) <= LARGEST and abs(theta) <= LARGEST):
            raise TurtleError(
                f"No turtle is spawned at x=[{x}], y=[{y}], theta=[{theta}]: each must be a finite number"
            )
        if not name:
            self._last_number = next(n for n in count(self._last_number + 1) if f"turtle{n}" not in self.turtles)
            name = f"turtle{self._last_number}"
        elif name in self.turtles:
            raise TurtleError(f"A turtle named [{name}] already exists")
        elif not _NAME.fullmatch(name):
            usable = re.sub(r"[^A-Za-z0-9_]+", "_", name).strip("_")
            usable = usable if usable and not usable[0].isdigit() else f"turtle_{usable}".rstrip("_")
            raise TurtleError(
                f"A turtle cannot be named [{name}]: its topic would be called [{name}/pose], and that name "
                f"has only letters, digits and underscores, no digit first; try [{usable}]"
            )
        x, y, theta = float32(x), float32(y), float32(theta)
        turtle = self.turtles[name] = Turtle(name, x, float32(HEIGHT - y), theta)
        return turtle

    def kill(self, name: str) -> Turtle:
        """Take a turtle out of the world and return it. Raises TurtleError if there is none of this name."""
        if name not in self.turtles:
            raise TurtleError(f"Tried to kill turtle [{name}], which does not exist")
        return self.turtles.pop(name)

    def clear(self) -> None:
        """Wipe what the pens have drawn; the turtles stay where they are."""
        self.canvas.clear()

    def reset(self) -> Turtle:
        """Begin anew with one turtle, turtle1, in the middle; returns it."""
        self.turtles.clear()
        self.canvas.clear()
        self._last_number = 0
        return self.spawn_in_the_middle()
