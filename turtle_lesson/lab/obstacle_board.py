"""The obstacles of the world, and the one publisher of /world/obstacles with which a page changes them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from ..turtlesim.obstacles import WORLDS, Box, Circle, to_marker_array
from . import recording
from .recorder import Recorder, apply
from .recording import NANOSECONDS, OBSTACLE_TOPIC

PATIENCE = 1.5 * NANOSECONDS
"""Robot time, ns, after which what was published must have been heard; the recorder looks around every second."""

Obstacle = Circle | Box


class ObstacleBoard:
    """Knows which obstacles there are, and puts others there.

    The topic is the truth, since other nodes may publish there, too. But a message takes time to arrive, and while
    the clock is paused it takes forever: until it is heard, what was put up last counts.
    """

    def __init__(self, recorder: Recorder, now: Callable[[], int] | None = None) -> None:
        """`now` tells the time, in ns since 1970, for a caller that can tell it without the node's clock."""
        self._recorder = recorder
        self._now = now or (lambda: recorder.node.get_clock().now().nanoseconds)
        self._publisher: Any = None
        self._put: tuple[Obstacle, ...] = ()
        self._expected: dict[tuple[str, int], recording.Obstacle] = {}
        self._deadline: float | None = None

    @property
    def obstacles(self) -> tuple[Obstacle, ...]:
        """The obstacles in the world."""
        heard = self._recorder.obstacles
        if heard == self._expected:
            self._deadline = None
            return self._put
        if self._deadline is not None and self._now() < self._deadline:
            return self._put
        return tuple(map(_heard, heard.values()))

    def put(self, obstacles: Iterable[Obstacle] | str) -> None:
        """Replace all obstacles, by others or by the name of a ready-made world, and publish them.

        Raises ValueError for a world that there is not, TypeError for what is no obstacle.
        """
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from rclpy.time import Time
        from visualization_msgs.msg import MarkerArray

        self._put = _checked(obstacles)
        now = self._now()
        message = to_marker_array(self._put, Time(nanoseconds=now).to_msg())
        self._expected = {}
        apply(message, self._expected)
        self._deadline = now + PATIENCE
        if self._publisher is None:
            latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            self._publisher = self._recorder.node.create_publisher(MarkerArray, OBSTACLE_TOPIC, latched)
        self._publisher.publish(message)


def _checked(obstacles: Iterable[Obstacle] | str) -> tuple[Obstacle, ...]:
    if isinstance(obstacles, str):
        if obstacles not in WORLDS:
            raise ValueError(f"there is no world called {obstacles!r}; there are {', '.join(map(repr, WORLDS))}")
        return WORLDS[obstacles]
    wanted = tuple(obstacles)
    for each in wanted:
        if not isinstance(each, (Circle, Box)):
            raise TypeError(f"an obstacle is a Circle or a Box, got {each!r}: try Circle(x=8.0, y=5.5, radius=0.5)")
    return wanted


def _heard(obstacle: recording.Obstacle) -> Obstacle:
    """An obstacle that another node has published. An oval becomes the circle of the same mean radius."""
    x, y, width, height = obstacle.x, obstacle.y, obstacle.width, obstacle.height
    if obstacle.shape == "box":
        return Box(x, y, width, height, obstacle.angle)
    return Circle(x, y, (width + height) / 4)
