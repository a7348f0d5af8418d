"""Obstacles out of a visualization_msgs/msg/MarkerArray, by the rules that RViz keeps."""

from __future__ import annotations

import math
from typing import Any

from .recording import Obstacle

# visualization_msgs/msg/Marker: its types and actions
CUBE, SPHERE, CYLINDER = 1, 2, 3
DELETE, DELETEALL = 2, 3


def apply(message: Any, obstacles: dict[tuple[str, int], Obstacle]) -> None:
    """Bring `obstacles` up to date with a MarkerArray: markers add, change and delete, one after the other.

    A marker is known by its namespace and number. Shapes that no turtle could run into (text, arrows, …) are
    left out.
    """
    for marker in message.markers:
        key = (marker.ns, marker.id)
        if marker.action == DELETEALL:
            obstacles.clear()
        elif marker.action == DELETE:
            obstacles.pop(key, None)
        elif marker.type in (CUBE, SPHERE, CYLINDER):
            obstacles[key] = _obstacle(marker)


def _obstacle(marker: Any) -> Obstacle:
    place, size, turn = marker.pose.position, marker.scale, marker.pose.orientation
    shape = "box" if marker.type == CUBE else "circle"
    return Obstacle(shape, place.x, place.y, size.x, size.y, _yaw(turn))


def _yaw(turn: Any) -> float:
    """The turn about the vertical axis, in radians, of any quaternion."""
    return math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y * turn.y + turn.z * turn.z))
