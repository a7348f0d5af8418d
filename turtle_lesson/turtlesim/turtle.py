"""Turtles: how one moves, tick by tick, what its pen draws, and all of a simulation, equal to the turtlesim of ROS 2 Humble.

No ROS in here. The arithmetic is that of ``turtle.cpp`` and ``turtle_frame.cpp``, which the recorded traces
in ``tests/data/turtlesim`` confirm to the last bit of every float32:

- the state is float64; the world's size, and the numbers that a spawn brings, are float32;
- y is kept *flipped*, measured down from the upper wall, as on a screen: the warning at a wall shows that
  number;
- one tick is 16 ms: first the heading, then the step along the new heading;
- the heading is kept in [-pi, pi) with a pi of only nine digits, 3.14159265: with the true one four poses of
  the recorded trace come out different;
- a command is taken up by the tick that follows it, one a tick and at most seven waiting (the real program
  looks into its subscription once a tick), and holds until it is older than 1 s: 63 ticks. So 1 m/s moves
  1.008 m.

Where it differs: a number that is NaN, infinite or absurdly large is refused (the real turtle would be at NaN
from then on, or beyond what its message can hold).
"""

import math
import re
import struct
from collections import deque
from itertools import count
from typing import TypeAlias

Colour: TypeAlias = tuple[int, int, int]
"""Red, green and blue, each from 0 to 255."""

BARE: Colour = (255, 255, 255)
"""What the sensor says where nothing was drawn."""

DEFAULT_PEN: Colour = (179, 184, 255)

PIXELS_PER_METRE = 45.0
CELL = 3 / PIXELS_PER_METRE
"""Side of a cell in metres."""

_SIDE = 500 / PIXELS_PER_METRE
_CELLS_PER_METRE = 1 / CELL
_ROW = 1024  # more than the cells in a row, so that a cell is one integer


def cell_at(x: float, y: float) -> int:
    """Return the number of the cell that holds the point (x, y), in metres."""
    return int(x * _CELLS_PER_METRE) * _ROW + int(y * _CELLS_PER_METRE)


Cells: TypeAlias = dict[int, Colour]
"""What the turtles' pens have drawn, as coarse cells by their numbers, each with its last colour, for the colour sensor.

The real turtlesim draws into a picture of 500 by 500 pixels, 45 to the metre, and its colour sensor reads the pixel under
the turtle. Two facts of that picture (``turtle_frame.cpp`` of Humble) are kept here:

- it lies on top of the background and starts out transparent *white*, so where nothing was drawn the sensor says
  (255, 255, 255), whatever the parameters ``background_r``, ``background_g`` and ``background_b`` are;
- a turtle sees the trail that it draws itself, from the second tick of a drive on.

The picture itself is not kept: a square cell as wide as a standard pen (3 pixels) remembers the last colour drawn through
its middle. So a wide pen leaves no broader trail for the sensor than a narrow one, and the edge of a trail is off by at
most a pen's width. That costs one dictionary look-up a tick.
"""


def draw(cells: Cells, start: tuple[float, float], end: tuple[float, float], colour: Colour) -> None:
    """Draw a straight line between two points, (x, y) in metres; a point beyond the picture is moved to its edge."""
    x0, y0, x1, y1 = (min(max(value, 0.0), _SIDE) for value in (*start, *end))
    dx, dy = x1 - x0, y1 - y0
    steps = int(max(abs(dx), abs(dy)) * _CELLS_PER_METRE * 2) + 1  # two samples a cell leave no gap
    for step in range(steps + 1):
        cells[cell_at(x0 + dx * step / steps, y0 + dy * step / steps)] = colour


TICK_MS = 16
TICK = 0.001 * TICK_MS
"""Duration of a tick in seconds."""

COMMAND_TICKS = 63
"""Ticks for which one command moves the turtle: the last one comes 0.992 s after the first."""

QUEUE_DEPTH = 7
LARGEST = 1e38
"""The largest number that is taken for a speed or a place: what comes of it still fits into a float32."""


PI = 3.14159265
TWO_PI = 2.0 * PI
CLOSE = 0.02
"""How near to a heading (rad) ends a rotation."""


def float32(value: float) -> float:
    """Round to the precision of a float32, as a message does."""
    return float(struct.unpack("f", struct.pack("f", value))[0])


def normalized(angle: float) -> float:
    """The same angle in [-pi, pi)."""
    return angle - TWO_PI * math.floor((angle + PI) / TWO_PI)


class TurtleError(ValueError):
    """Something was asked of the world that it cannot do; the text says what, and is what the node logs."""


WIDTH = HEIGHT = float32(499 / 45)
"""Size of the world in metres, 11.088889: 499 pixels, 45 to the metre."""


class Rotation:
    """A turn to a heading at 1 rad/s, the shorter way round, as the action ``rotate_absolute`` makes it.

    The arithmetic is that of ``turtle.cpp``, with its float32 here and there. ``step`` looks once a tick, before the turtle
    moves.

    Attributes:
        remaining: what is left to turn, in rad; negative to the right.
        delta: from where the turtle is heading to where it was heading at first, in rad.
        reached: whether it is there.
    """

    def __init__(self, goal: float, heading: float) -> None:
        self._goal = normalized(goal)
        self._start = heading
        self.remaining = self.delta = 0.0
        self.reached = False

    def step(self, heading: float) -> float:
        """The speed to turn at now, in rad/s."""
        off = self._goal - float32(heading)
        self.remaining = normalized(off)
        self.delta = normalized(float32(self._start - heading))
        if abs(normalized(-off)) < CLOSE:
            self.reached = True
            return 0.0
        return -1.0 if self.remaining < 0.0 else 1.0


class Turtle:
    """One turtle. It moves while its command is younger than 1 s, and is then soon ``at_rest``.

    Attributes that others read: ``name``; ``x``, ``flipped_y`` (m) and ``theta`` (rad); ``speed`` (m/s, never
    negative: the length of the velocity) and ``angular`` (rad/s); ``colour``, what its sensor sees;
    ``at_rest``, that the last tick has changed nothing of all these but perhaps the colour.
    """

    def __init__(self, name: str, x: float, flipped_y: float, theta: float) -> None:
        self.name = name
        self.x, self.flipped_y, self.theta = x, flipped_y, theta
        self.pen: Colour = DEFAULT_PEN
        self.pen_on = True
        self.colour: Colour = BARE
        self.at_rest = False  # it may have been spawned beyond a wall
        self._cell = cell_at(x, flipped_y)
        self._commands: deque[tuple[float, float, float]] = deque(maxlen=QUEUE_DEPTH)
        self._teleports: list[tuple[bool, float, float, float]] = []
        self._rotation: Rotation | None = None
        self._drive(0.0, 0.0, 0.0, ticks=1)

    @property
    def y(self) -> float:
        """Height above the lower wall in metres, as a pose shows it."""
        return HEIGHT - self.flipped_y

    def command(self, forward: float, sideways: float = 0.0, angular: float = 0.0) -> None:
        """Drive at these speeds (m/s ahead, m/s to the left, rad/s to the left) for the next 63 ticks.

        Raises TurtleError, and goes on as before, if one of them is not a usable number.
        """
        if not (abs(forward) <= LARGEST and abs(sideways) <= LARGEST and abs(angular) <= LARGEST):
            raise TurtleError(
                f"Turtle [{self.name}] ignores the velocity command linear.x={forward}, linear.y={sideways}, "
                f"angular.z={angular}: each must be a finite number; try math.isfinite before publishing"
            )
        self._commands.append((forward, sideways, angular))
        self.at_rest = False

    def teleport_absolute(self, x: float, y: float, theta: float) -> None:
        """Put the turtle at (x, y), in metres, heading theta, in radians, at the next tick."""
        self._teleport(False, x, y, theta)

    def teleport_relative(self, linear: float, angular: float) -> None:
        """Turn the turtle by ``angular`` radians, then move it ``linear`` metres ahead, at the next tick."""
        self._teleport(True, linear, 0.0, angular)

    def rotate_to(self, theta: float) -> Rotation:
        """Turn to the heading theta (rad, finite), from the next tick on; commands do nothing until it is reached."""
        self._rotation = Rotation(theta, self.theta)
        self.at_rest = False
        return self._rotation

    def stop_rotating(self) -> None:
        """Stop turning, and stand still."""
        self._rotation = None
        self._drive(0.0, 0.0, 0.0)

    def set_pen(self, colour: Colour, off: bool = False) -> None:
        """Lift the pen, or put it down with this colour."""
        self.pen_on = not off
        if not off:
            self.pen = colour

    def _drive(self, forward: float, sideways: float, angular: float, ticks: int = COMMAND_TICKS + 1) -> None:
        """Set the speeds, from this tick on; the last of the `ticks` stops the turtle, which is at rest after it."""
        self._forward, self._sideways, self.angular = forward, sideways, angular
        self.speed = math.sqrt(forward * forward + sideways * sideways)
        self._ticks_left = ticks

    def tick(self, cells: Cells) -> tuple[float, float] | None:
        """Move on by 16 ms. Returns where it would be, as (x, flipped y), had a wall not held it up."""
        if self.at_rest:
            self.colour = cells.get(self._cell, BARE)
            return None
        if self._teleports:
            self._carry_out_teleports(cells)
        self.colour = cells.get(self._cell, BARE)
        if self._commands:
            self._drive(*self._commands.popleft())
        if self._rotation is not None:
            self._drive(0.0, 0.0, self._rotation.step(self.theta))
            if self._rotation.reached:
                self._rotation = None
        left = self._ticks_left - 1
        if left < 0:
            self.at_rest = True
            return None
        self._ticks_left = left
        if left == 0:
            self._drive(0.0, 0.0, 0.0, ticks=0)
        return self._move(cells)

    def _move(self, cells: Cells) -> tuple[float, float] | None:
        theta = self.theta + self.angular * TICK
        if not -3.14 < theta < 3.14:  # in between, the formula changes nothing
            theta -= TWO_PI * math.floor((theta + PI) / TWO_PI)
        self.theta = theta
        cos, sin = math.cos(theta), math.sin(theta)
        forward, sideways = self._forward, self._sideways
        x = self.x + (cos * forward * TICK - sin * sideways * TICK)
        y = self.flipped_y - (cos * sideways * TICK + sin * forward * TICK)
        wall = None
        if not (0.0 <= x <= WIDTH and 0.0 <= y <= HEIGHT):
            wall = (x, y)
            x, y = min(max(x, 0.0), WIDTH), min(max(y, 0.0), HEIGHT)
        if x != self.x or y != self.flipped_y:
            self._cell = cell_at(x, y)
            if self.pen_on:
                if self.speed * TICK < CELL:  # the usual case is worth a short cut: no cell lies in between
                    cells[self._cell] = self.pen
                else:
                    draw(cells, (self.x, self.flipped_y), (x, y), self.pen)
            self.x, self.flipped_y = x, y
        return wall

    def _teleport(self, relative: bool, x: float, y: float, theta: float) -> None:
        if not (abs(x) <= LARGEST and abs(y) <= LARGEST and abs(theta) <= LARGEST):
            raise TurtleError(f"Turtle [{self.name}] stays where it is: each number of a teleport must be finite")
        self._teleports.append((relative, x, y, theta))
        self._ticks_left = self._ticks_left or 1
        self.at_rest = False

    def _carry_out_teleports(self, cells: Cells) -> None:
        for relative, x, y, theta in self._teleports:
            start = (self.x, self.flipped_y)
            if relative:
                self.theta += theta
                self.x += math.cos(self.theta) * x
                self.flipped_y -= math.sin(self.theta) * x
            else:
                self.x, self.flipped_y, self.theta = x, max(0.0, HEIGHT - y), theta
            if self.pen_on:
                draw(cells, start, (self.x, self.flipped_y), self.pen)
        self._teleports.clear()
        self._cell = cell_at(self.x, self.flipped_y)


# -- all turtles -------------------------------------------------------------------------------------------------------


_NAME = re.compile(r"/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")


class TurtleWorld:
    """Turtles in the order in which they were spawned, in a world of 11.088889 m by 11.088889 m."""

    def __init__(self) -> None:
        self.turtles: dict[str, Turtle] = {}
        self.cells: Cells = {}
        self._last_number = 0
        self.reset()

    def tick(self) -> dict[str, tuple[float, float]]:
        """Move all turtles on by 16 ms. Returns those that a wall held up, and where they would have been: (x, flipped y)."""
        cells = self.cells
        return {turtle.name: there for turtle in self.turtles.values() if (there := turtle.tick(cells)) is not None}

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
            raise TurtleError(
                f"A turtle cannot be named [{name}]: its topic would be called [{name}/pose], and that name "
                "has only letters, digits and underscores, no digit first"
            )
        x, y, theta = float32(x), float32(y), float32(theta)
        turtle = self.turtles[name] = Turtle(name, x, float32(HEIGHT - y), theta)
        return turtle

    def kill(self, name: str) -> Turtle:
        """Take a turtle out of the world and return it. Raises TurtleError if there is none of this name."""
        if name not in self.turtles:
            raise TurtleError(f"Tried to kill turtle [{name}], which does not exist")
        return self.turtles.pop(name)

    def reset(self) -> Turtle:
        """Begin anew with one turtle, turtle1, in the middle and facing +x; returns it."""
        self.turtles.clear()
        self.cells.clear()
        self._last_number = 0
        return self.spawn(WIDTH / 2, HEIGHT / 2, 0.0)
