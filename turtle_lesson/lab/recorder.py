"""The recorder hears a turtle's topics: what the lab knows, it knows from there and from the graph.

It must not be seen: a subscription makes a topic appear in `ros2 topic list`, and lets a waiting publisher
start. So it follows others, and only subscribes to a topic while somebody else publishes it (to `cmd_vel`:
while a simulator listens to it).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

from .channel import Channel
from .markers import apply
from .recording import OBSTACLE_TOPIC, SCAN_TOPIC, STATUS_TOPIC, STATUS_TYPE, Recording
from .table import LIMIT, Listener
from .track import WORLD

GLANCE_PERIOD = 1.0
"""Seconds between two glances at the graph, for publishers that come late in a node's life."""


@dataclass(frozen=True, slots=True)
class Advice:
    """What to try where nothing was heard: how to start a simulator, start the lesson's nodes, and wait."""

    simulator: str
    launch: str
    patience: str


_BY_HAND = "ros2 run turtlesim turtlesim_node"
IN_A_LESSON = Advice(
    simulator=f"start(simulator=True), or: {_BY_HAND}",
    launch='lesson.launch("robot_controller", "start_system.launch.py"), or: ros2 run robot_controller',
    patience="Let time pass: lesson.run(1.0)",
)
ON_A_ROBOT = Advice(
    simulator=f"in a terminal: {_BY_HAND}",
    launch="in a terminal: ros2 launch robot_controller start_system.launch.py, or: ros2 run robot_controller",
    patience="Wait a moment",
)


class Recorder(Recording):
    """Fills itself with what `node` (an rclpy Node, spun by somebody else) hears.

    `origin` (ns) is the moment that plots call 0 s; without it, that is now on the node's clock. `advice` is what to try
    where nothing was heard.
    """

    def __init__(
        self,
        node: Any,
        *,
        turtle: str = "turtle1",
        origin: int | None = None,
        limit: int = LIMIT,
        advice: Advice = IN_A_LESSON,
    ) -> None:
        if origin is None:
            origin = node.get_clock().now().nanoseconds
        super().__init__(turtle=turtle, origin=origin, limit=limit)
        self.node = node
        self._closed = False
        self._channels = self._make_channels(node, advice)
        self._timer = node.create_timer(GLANCE_PERIOD, self._glance)
        self._events = self._hear_of_new_nodes(node)
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
        self._closed = True
        for channel in self._channels.values():
            channel.close()
        self.node.destroy_subscription(self._events)
        self.node.destroy_timer(self._timer)

    def place(self) -> tuple[float, float, float] | None:
        """Where the turtle is, x, y (m) and theta (rad): turtlesim's middle until a pose was heard, None without it."""
        newest = self.poses.newest(1)
        if len(newest):
            x, y, theta = (float(newest[0][name]) for name in ("x", "y", "theta"))
            return x, y, theta
        return (WORLD / 2, WORLD / 2, 0.0) if self.node.count_publishers(self.pose_topic) else None

    def why_silent(self, topic: str) -> str:
        """A sentence on why nothing was heard on a topic, and what to try."""
        if self._closed:
            return f"No message had come on {topic} when the recorder was closed."
        self.look()
        return self._channels[topic].why_silent()

    def _make_channels(self, node: Any, advice: Advice) -> dict[str, Channel]:
        twist, pose = "geometry_msgs/msg/Twist", "turtlesim/msg/Pose"
        scan, markers = "sensor_msgs/msg/LaserScan", "visualization_msgs/msg/MarkerArray"
        commands = self.commands.listener("linear.x", "linear.y", "angular.z")
        poses = self.poses.listener("x", "y", "theta", "linear_velocity")
        simulator = f"Is the simulator running? Try {advice.simulator}"
        channel = partial(Channel, node, patience=advice.patience)
        channels = (
            channel(self.pose_topic, pose, lambda _: poses, simulator),
            channel(self.command_topic, twist, lambda _: commands, f"Try {advice.launch} navigator", driven=True),
            channel(STATUS_TOPIC, STATUS_TYPE, self._status_listener, f"Try {advice.launch} status_monitor"),
            channel(SCAN_TOPIC, scan, lambda _: self._hear_scan, f"Try {advice.launch} obstacle_detector"),
            channel(OBSTACLE_TOPIC, markers, lambda _: self._hear_markers, simulator, latched=True),
        )
        return {each.topic: each for each in channels}

    def _status_listener(self, message_type: Any) -> Listener:
        """A learner's TurtleStatus may lack a number that ours has: that column then holds nothing."""
        known = message_type.get_fields_and_field_types()
        numbers = {name for name, kind in known.items() if kind.rstrip("0123456789") in _NUMBERS}
        return self.statuses.listener(*(name if name in numbers else "" for name in self.statuses.names))

    def _hear_scan(self, message: Any, info: Any) -> None:
        self.scans.append(info["source_timestamp"])
        self.last_scan = message

    def _hear_markers(self, message: Any, info: Any) -> None:
        self.worlds.append(info["source_timestamp"])
        apply(message, self.obstacles)

    def _hear_of_new_nodes(self, node: Any) -> Any:
        """Look at the graph whenever a node has just started: every node then announces its parameters."""
        from rcl_interfaces.msg import ParameterEvent

        def look(event: Any) -> None:
            self.look()

        return node.create_subscription(ParameterEvent, "/parameter_events", look, 100)


_NUMBERS = {"float", "double", "int", "uint"}
