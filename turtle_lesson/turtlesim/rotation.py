"""A turn to a heading, as the action ``rotate_absolute`` of the turtlesim of ROS 2 Humble does it.

No ROS in here. The arithmetic is that of ``turtle.cpp``, with its float32 here and there, and equals a recording of a
real one: a turtle turns at 1 rad/s, the shorter way round, until it is less than 0.02 rad from the heading.
"""

import math
import struct

PI = 3.14159265
TWO_PI = 2.0 * PI
CLOSE = 0.02
"""How near to the heading (rad) is near enough."""


def float32(value: float) -> float:
    """Round to the precision of a float32, as a message does."""
    return float(struct.unpack("f", struct.pack("f", value))[0])


def normalized(angle: float) -> float:
    """The same angle in [-pi, pi)."""
    return angle - TWO_PI * math.floor((angle + PI) / TWO_PI)


class Rotation:
    """A turn on its way. ``step`` looks once a tick, before the turtle moves.

    Attributes:
        remaining: what is left to turn, in rad; negative to the right.
        delta: from where the turtle is heading to where it was heading at first, in rad.
        reached: whether it is there.
    """

    __slots__ = ("_goal", "_start", "delta", "reached", "remaining")

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
