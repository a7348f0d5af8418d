"""Recordings filled by hand, a node that answers for a graph, and orders to widgets: what the lab's tests share."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

from turtle_lesson.lab.recording import Recording
from turtle_lesson.turtlesim.obstacles import Obstacle

START = 1_800_000_000_000_000_000
"""The virtual wall clock at a lesson's start, in ns."""

SECOND = 1_000_000_000
TICK = 16_000_000
TWIST, POSE = "geometry_msgs/msg/Twist", "turtlesim/msg/Pose"
STATUS, SCAN = "robot_controller/msg/TurtleStatus", "sensor_msgs/msg/LaserScan"
NAVIGATE = "robot_controller/srv/NavigateTo"


def recording() -> Recording:
    """Nothing heard yet."""
    return Recording(origin=START)


def drive(
    heard: Recording,
    *,
    seconds: float = 2.0,
    speed: float = 1.0,
    at: tuple[float, float, float] = (5.544445, 5.544445, 0.0),
) -> Recording:
    """A turtle drives straight on, 62.5 poses and 10 statuses a second; returns the same recording."""
    x, y, theta = at
    first = len(heard.poses)
    for tick in range(1, round(seconds * 62.5) + 1):
        stamp = START + (first + tick) * TICK
        x += speed * math.cos(theta) * TICK / 1e9
        y += speed * math.sin(theta) * TICK / 1e9
        heard.poses.append(stamp, x, y, theta, speed)
    return heard


def report(heard: Recording, *, messages: int = 21, heading: float = 0.0) -> Recording:
    """A status monitor reports ten times a second, from 0.1 s on."""
    for number in range(messages):
        stamp = START + (number + 1) * 100_000_000
        heard.statuses.append(stamp, 5.0 + 0.1 * number, 5.0, heading, 1.0, 0.0, 100 - 0.1 * number)
    return heard


def scan(ranges: list[float], *, degrees: tuple[float, float] = (-90.0, 90.0), step: float = 1.0) -> Any:
    """A message like sensor_msgs/msg/LaserScan, for ranges from 0 to 10 m."""
    low, high = (math.radians(each) for each in degrees)
    angles = {"angle_min": low, "angle_max": high, "angle_increment": math.radians(step)}
    return SimpleNamespace(**angles, range_min=0.0, range_max=10.0, ranges=ranges)


def see(heard: Recording, message: Any, *, scans: int = 1) -> Recording:
    """Scans come five times a second, from 0.2 s on; `message` is the last one."""
    for number in range(scans):
        heard.scans.append(START + (number + 1) * 200_000_000)
    heard.last_scan = message
    return heard


def stand(heard: Recording, *obstacles: Obstacle) -> Recording:
    """Obstacles stand in the world."""
    heard.obstacles = {("obstacles", number): each for number, each in enumerate(obstacles)}
    return heard


Named = list[tuple[str, list[str]]]


class GraphNode:
    """Answers an rclpy node's questions about the graph: {node: {"pub" (sub, srv, cli): {topic: type}}}."""

    def __init__(self, nodes: dict[str, dict[str, dict[str, str]]], twins: tuple[str, ...] = ()) -> None:
        self.nodes = nodes
        self.twins = twins

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        return [_split(name) for name in (*self.nodes, *self.twins)]

    def get_publisher_names_and_types_by_node(self, name: str, namespace: str) -> Named:
        return self._ends("pub", name, namespace)

    def get_subscriber_names_and_types_by_node(self, name: str, namespace: str) -> Named:
        return self._ends("sub", name, namespace)

    def get_service_names_and_types_by_node(self, name: str, namespace: str) -> Named:
        return self._ends("srv", name, namespace)

    def get_client_names_and_types_by_node(self, name: str, namespace: str) -> Named:
        return self._ends("cli", name, namespace)

    def _ends(self, kind: str, name: str, namespace: str) -> Named:
        ends = self.nodes[f"{namespace.rstrip('/')}/{name}"].get(kind, {})
        return [(topic, [type_name]) for topic, type_name in ends.items()]


def _split(full_name: str) -> tuple[str, str]:
    namespace, name = full_name.rsplit("/", 1)
    return name, namespace or "/"


def order(widget: Any, name: str, /, **content: Any) -> None:
    """Give a widget the order that a view in a browser sends."""
    widget._order(widget, {"do": name, "view": "v", **content}, [])
