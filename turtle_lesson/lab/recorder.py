"""The recorder hears a turtle's topics: what the lab knows, it knows from there and from the graph. The board puts obstacles.

The recorder must not be seen: a subscription makes a topic appear in `ros2 topic list`, and lets a waiting publisher
start. So it follows others, and only subscribes to a topic while another node publishes it (to `cmd_vel`:
while a simulator listens to it).
"""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any

from rcl_interfaces.msg import ParameterEvent
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from rclpy.time import Time

from ..turtlesim.obstacles import WORLDS, Box, Circle, Obstacle, to_marker_array
from .graph import others, owner
from .recording import (
    COMMAND_TOPIC,
    NANOSECONDS,
    OBSTACLE_TOPIC,
    POSE_TOPIC,
    SCAN_TOPIC,
    STATUS_TOPIC,
    STATUS_TYPE,
    WORLD,
    Listener,
    Recording,
)
from .words import listed

GLANCE_PERIOD = 1.0
"""Seconds between two glances at the graph, for publishers that come late in a node's life."""

PATIENCE = 1.5 * NANOSECONDS
"""Robot time, ns, after which obstacles that were published must have been heard; the recorder looks around every second."""


Advice = tuple[str, str, str]
"""What to try where nothing was heard: how to start a simulator, how to start the lesson's nodes, and how to wait."""

IN_A_LESSON: Advice = (
    "start(simulator=True), or: ros2 run turtlesim turtlesim_node",
    'lesson.launch("robot_controller", "start_system.launch.py"), or: ros2 run robot_controller',
    "Let time pass: lesson.run(1.0)",
)
ON_A_ROBOT: Advice = (
    "in a terminal: ros2 run turtlesim turtlesim_node",
    "in a terminal: ros2 launch robot_controller start_system.launch.py, or: ros2 run robot_controller",
    "Wait a moment",
)


class Recorder(Recording):
    """Fills itself with what `node` (an rclpy Node, spun by its owner) hears.

    `origin` (ns) is the moment that plots call 0 s. `advice` is what to try where nothing was heard.
    """

    def __init__(self, node: Node, *, origin: int, advice: Advice = IN_A_LESSON) -> None:
        super().__init__(origin=origin)
        self.node = node
        self._channels = self._make_channels(node, advice)
        self._timer = node.create_timer(GLANCE_PERIOD, self._glance)
        # every node announces its parameters when it starts
        self._events = node.create_subscription(ParameterEvent, "/parameter_events", lambda _: self.look(), 100)
        self.look()

    def look(self) -> None:
        """Look at the graph, and listen to what has a publisher by now. Done by itself when a node starts."""
        for channel in self._channels.values():
            channel.follow()

    def _glance(self) -> None:
        for channel in self._channels.values():
            channel.glance()

    def close(self) -> None:
        """Stop listening; what was heard stays."""
        while self._channels:
            self._channels.popitem()[1].close()
        self.node.destroy_subscription(self._events)
        self.node.destroy_timer(self._timer)

    def place(self) -> tuple[float, float, float] | None:
        """Where the turtle is, x, y (m) and theta (rad): turtlesim's middle until a pose was heard, None without it."""
        middle = (WORLD / 2, WORLD / 2, 0.0) if self.node.count_publishers(POSE_TOPIC) else None
        return self.pose() or middle

    def why_silent(self, topic: str) -> str:
        """A sentence on why nothing was heard on a topic, and what to try."""
        if not self._channels:
            return f"No message had come on {topic} when the recorder was closed."
        self.look()
        return self._channels[topic].why_silent()

    def _make_channels(self, node: Node, advice: Advice) -> dict[str, Channel]:
        twist, pose = "geometry_msgs/msg/Twist", "turtlesim/msg/Pose"
        scan, markers = "sensor_msgs/msg/LaserScan", "visualization_msgs/msg/MarkerArray"
        commands = self.commands.listener("linear.x", "linear.y", "angular.z")
        poses = self.poses.listener("x", "y", "theta", "linear_velocity")
        start, launch, patience = advice
        simulator = f"Is the simulator running? Try {start}"
        channel = partial(Channel, node, patience=patience)
        channels = (
            channel(POSE_TOPIC, pose, lambda _: poses, simulator),
            channel(COMMAND_TOPIC, twist, lambda _: commands, f"Try {launch} navigator", driven=True),
            channel(STATUS_TOPIC, STATUS_TYPE, self._status_listener, f"Try {launch} status_monitor"),
            channel(SCAN_TOPIC, scan, lambda _: self._hear_scan, f"Try {launch} obstacle_detector"),
            channel(OBSTACLE_TOPIC, markers, lambda _: self._hear_markers, simulator, latched=True),
        )
        return {each.topic: each for each in channels}

    def _status_listener(self, message_type: Any) -> Listener:
        """A learner's TurtleStatus may lack a number that ours has: that column then holds nothing."""
        known = message_type.get_fields_and_field_types()
        kinds = ("float", "double", "int", "uint")
        numbers = {name for name, kind in known.items() if kind.rstrip("0123456789") in kinds}
        return self.statuses.listener(*(name if name in numbers else "" for name in self.statuses.names))

    def _hear_scan(self, message: Any, info: Any) -> None:
        self.scans.append(info["source_timestamp"])
        self.last_scan = message

    def _hear_markers(self, message: Any, info: Any) -> None:
        self.worlds.append(info["source_timestamp"])
        apply(message, self.obstacles)


DEPTH = 1000
"""Messages that wait if the recorder's node is not spun for a while: 16 seconds of a turtle's pose."""


@dataclass(eq=False)
class Channel:
    """Follows one topic of one type: subscribed to as long as another node is at its other end.

    A topic that drives a machine (`driven`) is followed while another node subscribes to it, any other while a node
    publishes it.
    """

    node: Node
    topic: str
    type_name: str
    make_listener: Callable[[Any], Listener]
    """It is given the message class and returns the two-argument callback."""
    remedy: str
    """What to try where no node publishes."""
    driven: bool = False
    latched: bool = False
    """Whether to ask for the last message from before, too."""
    patience: str = "Let time pass: lesson.run(1.0)"
    """What to try where a node publishes that has said nothing yet."""
    raw: bool = False
    """Whether messages stay bytes, which the listener does not read."""
    _message_type: Any = None
    _subscription: Subscription | None = None
    _count: int = -1

    @property
    def listens(self) -> bool:
        """Whether it is subscribed."""
        return self._subscription is not None

    def glance(self) -> None:
        """Follow, if the number of ends has changed since the last time: a cheap look, made often."""
        count = self.node.count_subscribers if self.driven else self.node.count_publishers
        if (number := count(self.topic)) != self._count:
            self._count = number
            self.follow()

    def follow(self) -> None:
        """Subscribe if another node is at the other end (of a driven topic, at this end), and unsubscribe if none is."""
        if self.driven:
            ends = others(self.node, self.node.get_subscriptions_info_by_topic(self.topic))
        else:
            ends = self.node.get_publishers_info_by_topic(self.topic)
        message_type = None
        if any(end.topic_type == self.type_name for end in ends):
            with suppress(ValueError):  # its package is not built and sourced
                message_type = find_class(self.type_name)
        if message_type is self._message_type:
            return
        self.close()
        if message_type is not None:
            self._message_type = message_type
            # best effort matches every publisher; only a latched topic has to be reliable to give its past
            quality = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)
            if self.latched:
                quality = QoSProfile(depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            hear = self.make_listener(message_type)
            self._subscription = self.node.create_subscription(message_type, self.topic, hear, quality, raw=self.raw)

    def close(self) -> None:
        """Unsubscribe."""
        if self._subscription is not None:
            self.node.destroy_subscription(self._subscription)
        self._subscription = self._message_type = None

    def why_silent(self) -> str:
        """Why nothing was heard, and what to try."""
        publishers = self.node.get_publishers_info_by_topic(self.topic)
        if not publishers:
            return f"No node publishes {self.topic}. {self.remedy}"
        types = sorted({publisher.topic_type for publisher in publishers})
        if self.type_name not in types:
            mismatch = f"{self.topic} is published as {listed(types)}, but this plot reads {self.type_name}"
            return f"{mismatch}: compare the types in ros2 topic info {self.topic} --verbose"
        try:
            find_class(self.type_name)
        except ValueError as error:
            return f"{self.topic} is published, but {error}"
        names = listed(sorted(set(map(owner, publishers))))
        return f"{names} can publish {self.topic}, but no message has come yet. {self.patience}"


def find_class(type_name: str) -> Any:
    """The class of "geometry_msgs/msg/Twist", "geometry_msgs/Twist" or "turtlesim/srv/Spawn".

    Raises ValueError where it cannot be imported, with what to try.
    """
    package, _, rest = type_name.partition("/")
    folder, _, name = rest.rpartition("/")
    try:
        return getattr(importlib.import_module(f"{package}.{folder or 'msg'}"), name)
    except (ImportError, AttributeError):
        raise ValueError(
            f"the type {type_name} cannot be imported here: is its package built and sourced? Try "
            f"colcon build --packages-select {package}, then source install/setup.bash"
        ) from None


# visualization_msgs/msg/Marker: its types and actions
CUBE, SPHERE, CYLINDER = 1, 2, 3
DELETE, DELETEALL = 2, 3


Obstacles = dict[tuple[str, int], Obstacle]
"""By a marker's namespace and number."""


def apply(message: Any, obstacles: Obstacles) -> None:
    """Bring `obstacles` up to date with a MarkerArray: markers add, change and delete, one after the other.

    Shapes that no turtle could run into (text, arrows, …) are left out.
    """
    for marker in message.markers:
        key = (marker.ns, marker.id)
        if marker.action == DELETEALL:
            obstacles.clear()
        elif marker.action == DELETE:
            obstacles.pop(key, None)
        elif marker.type in (CUBE, SPHERE, CYLINDER):
            place, size, turn = marker.pose.position, marker.scale, marker.pose.orientation
            yaw = math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y * turn.y + turn.z * turn.z))
            with suppress(ValueError):  # one without a size
                if marker.type == CUBE:
                    obstacles[key] = Box(place.x, place.y, size.x, size.y, yaw)
                else:  # an oval becomes the circle of the same mean radius
                    obstacles[key] = Circle(place.x, place.y, (size.x + size.y) / 4)


class ObstacleBoard:
    """Knows which obstacles there are, and puts others there.

    The topic is the truth, since other nodes may publish there, too. But a message takes time to arrive, and while
    the clock is paused it takes forever: until it is heard, what was put up last counts.
    """

    def __init__(self, recorder: Recorder, now: Callable[[], int] | None = None) -> None:
        """`now` tells the time, in ns since 1970, for a caller that can tell it without the node's clock."""
        self._recorder = recorder
        self._now = now or (lambda: recorder.node.get_clock().now().nanoseconds)
        self._publisher: Publisher | None = None
        self._put: tuple[Obstacle, ...] = ()
        self._expected: Obstacles = {}
        self._deadline = -math.inf

    @property
    def obstacles(self) -> tuple[Obstacle, ...]:
        """The obstacles in the world."""
        heard = self._recorder.obstacles
        if heard == self._expected:
            self._deadline = -math.inf
            return self._put
        return self._put if self._now() < self._deadline else tuple(heard.values())

    def put(self, obstacles: Iterable[Obstacle] | str) -> None:
        """Replace all obstacles, by others or by the name of a ready-made world, and publish them.

        Raises ValueError for a world that there is not, TypeError for what is no obstacle.
        """
        from visualization_msgs.msg import MarkerArray

        if isinstance(obstacles, str):
            if obstacles not in WORLDS:
                raise ValueError(f"there is no world called {obstacles!r}; there are {', '.join(map(repr, WORLDS))}")
            obstacles = WORLDS[obstacles]
        wanted = tuple(obstacles)
        for each in wanted:
            if not isinstance(each, (Circle, Box)):
                raise TypeError(f"an obstacle is a Circle or a Box, got {each!r}: try Circle(x=8.0, y=5.5, radius=0.5)")
        self._put = wanted
        now = self._now()
        message = to_marker_array(self._put, Time(nanoseconds=now).to_msg())
        self._expected = {}
        apply(message, self._expected)
        self._deadline = now + PATIENCE
        if self._publisher is None:
            latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            self._publisher = self._recorder.node.create_publisher(MarkerArray, OBSTACLE_TOPIC, latched)
        self._publisher.publish(message)
