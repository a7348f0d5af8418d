"""What has been heard of a turtle, as numbers: the plots read this, the recorder fills it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Real
from typing import Any

import numpy as np

from .table import LIMIT, Table
from .words import number

NANOSECONDS = 1_000_000_000

STATUS_TOPIC = "/robot/status"
STATUS_TYPE = "robot_controller/msg/TurtleStatus"
SCAN_TOPIC = "/obstacles"
OBSTACLE_TOPIC = "/world/obstacles"

UNDER_WAY = 1_000_000
"""Nanoseconds that a message takes at most here. A pose sent later than this before a scan was not known to its scanner."""


@dataclass(frozen=True, slots=True)
class Obstacle:
    """A thing in the world seen from above: "circle" or "box", middle and size in metres, turn in radians."""

    shape: str
    x: float
    y: float
    width: float
    height: float
    angle: float = 0.0


class Recording:
    """The newest messages about one turtle, in the order in which they came.

    `origin` (ns) is the moment that plots call 0 s. Tables keep `limit` rows each. `last_scan` is the newest
    sensor_msgs/msg/LaserScan, `obstacles` what stands in the world now.
    """

    def __init__(self, *, turtle: str = "turtle1", origin: int = 0, limit: int = LIMIT) -> None:
        self.turtle = turtle
        self.origin = origin
        self.poses = Table("x", "y", "theta", "speed", limit=limit)
        self.commands = Table("forward", "sideways", "turn", limit=limit)
        self.statuses = Table("x", "y", "theta", "vel_x", "vel_y", "battery", limit=limit)
        self.scans = Table(limit=limit)
        self.worlds = Table(limit=limit)
        self.last_scan: Any = None
        self.obstacles: dict[tuple[str, int], Obstacle] = {}

    @property
    def pose_topic(self) -> str:
        """The topic that tells where the turtle is."""
        return f"/{self.turtle}/pose"

    @property
    def command_topic(self) -> str:
        """The topic that tells the turtle how to move."""
        return f"/{self.turtle}/cmd_vel"

    def seconds(self, stamps: Any) -> Any:
        """Times in ns (a number or an array) as seconds since `origin`."""
        return (stamps - self.origin) / NANOSECONDS

    def window(self, table: Table, since: float | None = None, until: float | None = None) -> np.ndarray:
        """The rows of a table from `since` to `until` (seconds since `origin`, both ends included)."""
        rows = table.array()
        chosen = np.ones(len(rows), bool)
        if since is not None:
            chosen &= rows["stamp"] >= self._stamp("since", since)
        if until is not None:
            chosen &= rows["stamp"] <= self._stamp("until", until)
        return rows[chosen]

    def span(self, table: Table) -> str:
        """From when to when a table has rows: "0.02 s to 24.51 s of robot time"."""
        first, last = self.seconds(table.array()["stamp"][[0, -1]])
        return f"{number(first)} s to {number(last)} s of robot time"

    def why_silent(self, topic: str) -> str:
        """A sentence on why nothing was heard on a topic, and what to try."""
        return f"No message has come on {topic} yet. Let robot time pass: lesson.run(1.0)."

    def _stamp(self, name: str, seconds: float) -> int:
        if not isinstance(seconds, Real) or not math.isfinite(seconds):
            raise ValueError(
                f"{name} must be a time in seconds since the lesson's start, got {seconds!r}: try {name}=10.0"
            )
        return self.origin + round(seconds * NANOSECONDS)
