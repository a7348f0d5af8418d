"""Obstacles that a page places in the world: circles and boxes, and how they travel as a ROS message.

They stand on the floor of the turtles' world (11.09 m by 11.09 m, the origin in the lower left corner) and never move.
A turtle drives through them, as through the real turtlesim's empty world; a range sensor sees them.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields
from numbers import Real
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

if TYPE_CHECKING:
    from visualization_msgs.msg import MarkerArray

FRAME = "world"
NAMESPACE = "obstacles"
MARKER_HEIGHT = 0.5
"""Height in metres at which a marker is drawn; the turtles' world itself is flat."""

COLOUR = (0.90, 0.62, 0.0, 1.0)
"""Red, green, blue and opacity: the orange of Okabe and Ito's palette, told apart from the turtle's blues by all eyes."""

_EXAMPLES = {"Circle": "Circle(x=3.0, y=4.0, radius=0.5)", "Box": "Box(x=3.0, y=4.0, width=2.0, height=0.5)"}


def _check_numbers(obstacle: "Circle | Box", positive: tuple[str, ...]) -> None:
    """Turn all fields into floats; refuse what is no finite number, and a size that is not above zero."""
    for field in fields(obstacle):
        value = getattr(obstacle, field.name)
        number = isinstance(value, Real) and not isinstance(value, bool)
        if number and math.isfinite(value) and (field.name not in positive or value > 0):
            object.__setattr__(obstacle, field.name, float(value))
        else:
            kind = type(obstacle).__name__
            wanted = "a number above zero" if field.name in positive else "a finite number"
            unit = "radians" if field.name == "angle" else "metres"
            error = ValueError if number else TypeError
            raise error(f"{kind}: {field.name} must be {wanted}, in {unit}, not {value!r}; try {_EXAMPLES[kind]}")


@dataclass(frozen=True, slots=True)
class Circle:
    """A round obstacle: middle (x, y) and radius, in metres."""

    x: float
    y: float
    radius: float

    shape: ClassVar = "circle"
    angle: ClassVar = 0.0

    @property
    def width(self) -> float:
        """From side to side, m; `height` is the same."""
        return 2 * self.radius

    height = width

    def __post_init__(self) -> None:
        _check_numbers(self, positive=("radius",))

    def __str__(self) -> str:
        return f"circle at ({self.x:.2f}, {self.y:.2f}), radius {self.radius:.2f} m"


@dataclass(frozen=True, slots=True)
class Box:
    """A rectangular obstacle: middle (x, y), width along its own x axis and height along its own y axis, in metres.

    ``angle`` in radians turns it about its middle, counter-clockwise.
    """

    x: float
    y: float
    width: float
    height: float
    angle: float = 0.0

    shape: ClassVar = "box"

    def __post_init__(self) -> None:
        _check_numbers(self, positive=("width", "height"))

    def __str__(self) -> str:
        text = f"box at ({self.x:.2f}, {self.y:.2f}), {self.width:.2f} m by {self.height:.2f} m"
        if self.angle:
            text += f", turned by {self.angle:.2f} rad ({math.degrees(self.angle):.0f}°)"
        return text


Obstacle: TypeAlias = Circle | Box

WORLDS: dict[str, tuple[Obstacle, ...]] = {
    "empty": (),
    "three pillars": (Circle(8.5, 5.5, 0.4), Circle(3.5, 8.0, 0.5), Circle(4.0, 2.5, 0.6)),
    "corridor": (Box(5.5, 7.0, 9.0, 0.3), Box(5.5, 4.0, 9.0, 0.3), Circle(9.0, 5.5, 0.3)),
    "slalom": (Circle(2.0, 5.0, 0.3), Circle(4.0, 6.5, 0.3), Circle(7.0, 5.0, 0.3), Circle(9.0, 6.5, 0.3)),
    "rooms": (
        Box(2.0, 7.5, 4.0, 0.2),
        Box(9.0, 7.5, 4.0, 0.2),
        Box(7.5, 1.5, 0.2, 3.0),
        Box(3.0, 2.5, 1.0, 0.6, angle=math.pi / 6),
        Circle(9.3, 9.3, 0.5),
    ),
}
"""Example worlds by name. All leave the middle, where the turtle starts, free by more than a metre."""


def to_marker_array(obstacles: Iterable[Obstacle], stamp: Any) -> "MarkerArray":
    """Return a ``visualization_msgs/MarkerArray`` that shows exactly these obstacles.

    Its first marker deletes what was shown before, so that the newest message is the whole truth. Then comes
    a CYLINDER for each circle and a CUBE for each box, numbered from 0. ``stamp`` is a
    ``builtin_interfaces/Time``.
    """
    from visualization_msgs.msg import Marker, MarkerArray

    markers = [Marker(action=Marker.DELETEALL)]
    for number, obstacle in enumerate(obstacles):
        kind = Marker.CYLINDER if isinstance(obstacle, Circle) else Marker.CUBE
        marker = Marker(ns=NAMESPACE, id=number, action=Marker.ADD, type=kind)
        position, turn = marker.pose.position, marker.pose.orientation
        position.x, position.y = obstacle.x, obstacle.y
        position.z = MARKER_HEIGHT / 2  # a marker's position is its middle: let it stand on the floor
        turn.z, turn.w = math.sin(obstacle.angle / 2), math.cos(obstacle.angle / 2)
        marker.scale.x, marker.scale.y, marker.scale.z = obstacle.width, obstacle.height, MARKER_HEIGHT
        marker.color.r, marker.color.g, marker.color.b, marker.color.a = COLOUR
        markers.append(marker)
    for marker in markers:
        marker.header.frame_id, marker.header.stamp = FRAME, stamp
    return MarkerArray(markers=markers)
