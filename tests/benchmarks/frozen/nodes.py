"""The callbacks of the three nodes and of the recorder, as they were when this benchmark was made, without ROS.

Nothing in this folder follows later changes of the package: it is the measure that the whole system is compared with.
Left out is what a drive among pillars does not use. `speed_of_light.py` calls it, and checks that its poses, commands,
statuses and scans are those of the system.
"""

from __future__ import annotations

import math
import struct
from array import array
from collections import deque
from collections.abc import Callable
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from .messages import Scan, Status, Twist
from .turtle import TICK

SECOND = 1_000_000_000
WORLD_SIZE = 11.088889


class Parameter:
    """A parameter's value."""

    def __init__(self, value: Any) -> None:
        self._value = value

    @property
    def value(self) -> Any:
        """The value, as Python has it."""
        return self._value


class Node:
    """What a callback uses of its node: the time, parameters, and a log."""

    def __init__(self, clock: Callable[[], int], **parameters: Any) -> None:
        self.clock = clock
        self.log: deque[str] = deque(maxlen=500)
        self._parameters = {name: Parameter(value) for name, value in parameters.items()}

    def get_parameter(self, name: str) -> Parameter:
        """A declared parameter."""
        if name not in self._parameters:
            raise KeyError(name)
        return self._parameters[name]

    def value(self, name: str) -> Any:
        """The value of a parameter."""
        return self.get_parameter(name).value


# -- the navigator ------------------------------------------------------------------------------------------------


class Limits(NamedTuple):
    """What a drive must keep to."""

    linear_speed: float
    angular_speed: float
    goal_tolerance: float
    heading_tolerance: float


class Goal(NamedTuple):
    """Where to drive, in metres and radians."""

    x: float
    y: float
    theta: float


def wrap(angle: float) -> float:
    """The same direction as an angle in [-pi, pi]."""
    return math.remainder(angle, math.tau)


def errors(pose: Any, goal: Goal) -> tuple[float, float]:
    """How far the goal is (m), and the angle by which the heading still has to turn (rad, signed)."""
    return math.hypot(goal.x - pose.x, goal.y - pose.y), wrap(goal.theta - pose.theta)


def steer(pose: Any, goal: Goal, limits: Limits, turning: float) -> tuple[float, float, bool]:
    """The next command (m/s, rad/s), and whether the turtle is there."""
    distance, turn = errors(pose, goal)
    if distance > 0.25 * limits.goal_tolerance:
        return (*approach(pose, goal, limits, turning), False)
    if abs(turn) > 0.25 * limits.heading_tolerance:
        return 0.0, turning_speed(turn, limits, turning), False
    return 0.0, 0.0, True


def approach(pose: Any, goal: Goal, limits: Limits, turning: float) -> tuple[float, float]:
    """The next command while the goal is away."""
    dx, dy = goal.x - pose.x, goal.y - pose.y
    distance, turn = math.hypot(dx, dy), wrap(math.atan2(dy, dx) - pose.theta)
    angular = turning_speed(turn, limits, turning)
    if abs(turn) > 0.5:
        return 0.0, angular
    linear = min(4.0 * distance, limits.linear_speed)
    sideways, bearable = linear * abs(math.sin(turn)), 0.5 * limits.angular_speed * distance
    return (linear * (bearable / sideways) if sideways > bearable else linear), angular


def turning_speed(turn: float, limits: Limits, turning: float) -> float:
    """How fast to turn by an angle in [-pi, pi]."""
    if abs(turn) > 1.5 and turn * turning < 0.0:
        turn = -turn
    return max(-limits.angular_speed, min(limits.angular_speed, 5.0 * turn))


class Navigator(Node):
    """Drives to one goal after the other."""

    publish: Callable[[Any], object]
    answer: Callable[[bool], object]

    def __init__(self, clock: Callable[[], int]) -> None:
        super().__init__(
            clock,
            goal_timeout=5.0,
            linear_speed=4.0,
            angular_speed=6.0,
            goal_tolerance=0.2,
            heading_tolerance=0.1,
            obstacle_warning_distance=0.4,
        )
        self._pose: Any = None
        self._ticks_without_pose = 0
        self._goal: Goal | None = None
        self._warned = -2 * SECOND
        self._obstacle_near = False

    def on_pose(self, pose: Any) -> None:
        """Keep the newest pose."""
        self._pose = pose
        self._ticks_without_pose = 0

    def on_scan(self, scan: Any) -> None:
        """Warn of what is near."""
        low, high = scan.range_min, min(self.value("obstacle_warning_distance"), scan.range_max)
        distance = min([reading for reading in scan.ranges if reading < high and reading >= low], default=None)
        if distance is not None and (self._goal is not None or not self._obstacle_near):
            text = f"Obstacle {distance:.2f} m away"
            if self.clock() >= self._warned + 2 * SECOND:
                self._warned = self.clock()
                self.log.append(text)
        self._obstacle_near = distance is not None

    def on_navigate_to(self, goal: Goal) -> None:
        """Start a drive; `answer` is called when it has ended."""
        self.log.append(f"Goal accepted: x {goal.x:.2f} m, y {goal.y:.2f} m, theta {goal.theta:.2f} rad")
        self._goal, self._turning, self._started, self._stopped = goal, 0.0, 0, 0
        self.continue_drive(goal)

    def on_steering_timer(self) -> None:
        """Go on with the drive that is under way, if any."""
        self._ticks_without_pose += 1
        if self._goal is not None:
            self.continue_drive(self._goal)

    def continue_drive(self, goal: Goal) -> None:
        """Send the next command, or say how it went."""
        pose = self._pose
        if pose is None or self._ticks_without_pose > 1:
            raise RuntimeError("no pose was heard")
        if not self._stopped:
            self._drive(pose, goal)
        else:
            self._judge(pose, goal)

    def _drive(self, pose: Any, goal: Goal) -> None:
        now = self.clock()
        self._started = self._started or now
        linear, self._turning, there = steer(pose, goal, self._limits(), self._turning)
        if there or self._time_over(now):
            self._stopped = now
            self._send(0.0, 0.0)
        else:
            self._send(linear, self._turning)

    def _judge(self, pose: Any, goal: Goal) -> None:
        limits = self._limits()
        distance, turn = errors(pose, goal)
        reached = distance <= limits.goal_tolerance and abs(turn) <= limits.heading_tolerance
        if not reached and not self._time_over(self.clock()):
            self._stopped = 0
            self._drive(pose, goal)
            return
        seconds = (self._stopped - self._started) / SECOND
        self.log.append(f"Goal reached ({reached}): {distance:.2f} m and {abs(turn):.2f} rad after {seconds:.1f} s")
        self._goal = None
        self.answer(reached)

    def _limits(self) -> Limits:
        return Limits(*map(self.value, Limits._fields))

    def _time_over(self, now: int) -> bool:
        return (now - self._started) / SECOND > self.value("goal_timeout") - 0.05

    def _send(self, linear: float, angular: float) -> None:
        command = Twist()
        command.linear.x = round(linear, 6)
        command.angular.z = round(angular, 6)
        self.publish(command)


# -- the status monitor -------------------------------------------------------------------------------------------


class StatusMonitor(Node):
    """Says ten times a second where the turtle is, and how it moves."""

    publish: Callable[[Any], object]

    def __init__(self, clock: Callable[[], int]) -> None:
        super().__init__(clock, publish_rate=10)
        self._before: Any = None
        self._pose: Any = None
        self._ticks_without_pose = 0
        self._charge = 1000

    def on_pose(self, pose: Any) -> None:
        """Keep the newest two poses."""
        self._before, self._pose = self._pose, pose
        self._ticks_without_pose = 0

    def on_publish_timer(self) -> None:
        """Publish one status, and use up a little of the battery."""
        self._ticks_without_pose += 1
        lost = self._ticks_without_pose / self.value("publish_rate") > 1.0
        before, pose = self._before, self._pose
        status = Status(battery=self._charge / 10)
        if pose is not None:
            status.x, status.y, status.theta = pose.x, pose.y, pose.theta
            if before is not None and not lost:
                status.vel_x, status.vel_y = world_velocity(before, pose)
        self.publish(status)
        self._charge = max(0, self._charge - 1)


def world_velocity(before: Any, now: Any) -> tuple[float, float]:
    """The velocity along the world's axes, m/s, between two poses that follow each other."""
    dx, dy = now.x - before.x, now.y - before.y
    way = math.hypot(dx, dy)
    if way == 0.0:
        return 0.0, 0.0
    speed = min(way / TICK, now.linear_velocity)
    return speed * dx / way, speed * dy / way


# -- the obstacle detector ----------------------------------------------------------------------------------------

BEAMS = 181
RANGE_MAX = 10.0
NOT_ZERO = 1e-300
ANGLES = [math.radians(degree) for degree in range(-90, 91)]
FORWARD = np.array([math.cos(angle) for angle in ANGLES])
LEFT = np.array([math.sin(angle) for angle in ANGLES])


class ObstacleDetector(Node):
    """Publishes a scan five times a second: made-up readings, or the distances to walls and pillars."""

    publish: Callable[[Any], object]

    def __init__(self, clock: Callable[[], int], source: str, pillars: Any) -> None:
        super().__init__(clock, scan_rate=5, source=source)
        self.random = np.random.RandomState(0)
        self._pillars = pillars
        self._pose: Any = None

    def on_pose(self, pose: Any) -> None:
        """Keep the place to measure from."""
        self._pose = pose

    def on_scan_timer(self) -> None:
        """Publish one scan."""
        if self.value("source") == "world":
            pose = self._pose
            readings = cast_rays(pose.x, pose.y, pose.theta, self._pillars)
        else:
            met = self.random.random_sample(BEAMS) < 0.05
            readings = np.where(met, np.float32(0.5), np.float32(RANGE_MAX))
        self._publish(array("f", readings.tobytes()), 1.0 / self.value("scan_rate"))

    def _publish(self, readings: array[float], period: float) -> None:
        scan = Scan()
        scan.sec, scan.nanosec = divmod(self.clock(), SECOND)
        scan.frame_id = "base_link"
        scan.angle_min, scan.angle_max = -math.pi / 2, math.pi / 2
        scan.angle_increment = math.pi / (BEAMS - 1)
        scan.scan_time = period
        scan.range_min, scan.range_max = 0.0, RANGE_MAX
        scan.ranges = readings
        self.publish(scan)


def cast_rays(x: float, y: float, heading: float, circles: Any) -> Any:
    """The distance in metres to the first wall or circle (rows of x, y, radius), for each beam from right to left."""
    cos, sin = math.cos(heading), math.sin(heading)
    along_x = FORWARD * cos - LEFT * sin + NOT_ZERO
    along_y = FORWARD * sin + LEFT * cos + NOT_ZERO
    distance = np.minimum(to_walls(x, along_x), to_walls(y, along_y))
    dx, dy, radius = circles[:, 0:1] - x, circles[:, 1:2] - y, circles[:, 2:3]
    ahead = along_x * dx + along_y * dy
    beside = along_x * dy - along_y * dx
    squared = radius * radius - beside * beside
    half_chord = np.sqrt(np.maximum(squared, 0.0))
    hit = (squared >= 0.0) & (ahead + half_chord >= 0.0)
    np.minimum(distance, np.where(hit, ahead - half_chord, np.inf).min(axis=0), out=distance)
    return np.maximum(np.minimum(distance, RANGE_MAX), 0.0).astype(np.float32)


def to_walls(place: float, along: Any) -> Any:
    """The distance to that one of two facing walls which a beam runs towards."""
    return np.maximum(-place / along, (WORLD_SIZE - place) / along)


# -- the recorder -------------------------------------------------------------------------------------------------


class Table:
    """Rows of a stamp (ns) and a few numbers of a message."""

    def __init__(self, *paths: str) -> None:
        self.rows = bytearray()
        self._read, self._pack = attrgetter(*paths), struct.Struct(f"=q{len(paths)}d").pack

    def hear(self, message: Any, info: dict[str, int]) -> None:
        """A message is heard: add its row."""
        self.rows += self._pack(info["source_timestamp"], *self._read(message))
        if len(self.rows) > 10_000_000:
            del self.rows[:5_000_000]


class Recorder:
    """Keeps a row for each pose, command and status, and the newest scan."""

    def __init__(self) -> None:
        self.poses = Table("x", "y", "theta", "linear_velocity")
        self.commands = Table("linear.x", "linear.y", "angular.z")
        self.statuses = Table("x", "y", "theta", "vel_x", "vel_y", "battery")
        self.scans: list[int] = []
        self.last_scan: Any = None

    def on_scan(self, scan: Any, info: dict[str, int]) -> None:
        """A scan is heard."""
        self.scans.append(info["source_timestamp"])
        self.last_scan = scan
