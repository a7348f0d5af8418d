#!/usr/bin/env python3
"""The obstacle detector: publishes what a laser scanner on the turtle would see, from right to left.

Run it with `ros2 run robot_controller obstacle_detector`, and watch it with `ros2 topic echo /obstacles`. By
itself it makes up its readings. With `--ros-args -p source:=world` it measures: from the turtle's pose to the
walls and to the obstacles that the simulator shows on `/world/obstacles`.
"""

from __future__ import annotations

import math
import random
from array import array
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import rclpy
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.subscription import Subscription
from sensor_msgs.msg import LaserScan
from visualization_msgs.msg import Marker, MarkerArray

try:
    from turtlesim.msg import Pose
except ImportError:  # ROS 2 Kilted and newer keep turtlesim's messages in a package of their own
    from turtlesim_msgs.msg import Pose

Floats = npt.NDArray[np.float64]

WORLD_SIZE = 11.088889
"""Side of turtlesim's square world, m."""

BEAMS = 181
"""One beam each degree from -90 to +90: 180 steps have 181 ends."""

RANGE_MAX = 10.0
"""The scanner sees no further than this, m. A beam that meets nothing nearer reads exactly this."""

MOCK_DISTANCE = 0.5
MOCK_SHARE = 0.05
"""What made-up readings show: this share of the beams meets something at this distance, m."""

SOURCES = ("mock", "world")

PATIENCE = 1.0
"""Without a pose for so long, s, there is nothing to measure from."""

NOT_ZERO = 1e-300
"""Added to a beam's components, it changes only an exact 0, by which a beam along an axis would divide."""

# The directions of the beams in the turtle's own frame. A scan turns all of them to the turtle's heading with
# four multiplications a beam; these, unlike a sine, give the same bits on every machine.
_ANGLES = [math.radians(degree) for degree in range(-90, 91)]
_FORWARD = np.array([math.cos(angle) for angle in _ANGLES])
_LEFT = np.array([math.sin(angle) for angle in _ANGLES])


class Obstacles(NamedTuple):
    """What stands in the world, in metres, a row for each obstacle.

    `circles` has the columns x, y, radius; `boxes` has x, y, half the length along its own axes x and y, and
    the cosine and sine of its heading.
    """

    circles: Floats
    boxes: Floats


NOTHING = Obstacles(np.empty((0, 3)), np.empty((0, 6)))


def cast_rays(x: float, y: float, heading: float, obstacles: Obstacles) -> npt.NDArray[np.float32]:
    """Return the distance in metres to the first wall or obstacle, for each beam from right (-90°) to left.

    A place inside an obstacle reads 0 everywhere; what is further than RANGE_MAX reads RANGE_MAX.
    """
    cos, sin = math.cos(heading), math.sin(heading)
    along_x = _FORWARD * cos - _LEFT * sin + NOT_ZERO
    along_y = _FORWARD * sin + _LEFT * cos + NOT_ZERO
    distance = np.minimum(_to_walls(x, along_x), _to_walls(y, along_y))
    if len(obstacles.circles):
        np.minimum(distance, _to_circles(x, y, along_x, along_y, obstacles.circles), out=distance)
    if len(obstacles.boxes):
        np.minimum(distance, _to_boxes(x, y, along_x, along_y, obstacles.boxes), out=distance)
    return np.maximum(np.minimum(distance, RANGE_MAX), 0.0).astype(np.float32)


def _to_walls(place: float, along: Floats) -> Floats:
    """Return the distance to that one of two facing walls which a beam runs towards."""
    return np.maximum(-place / along, (WORLD_SIZE - place) / along)


def _to_circles(x: float, y: float, along_x: Floats, along_y: Floats, circles: Floats) -> Floats:
    """Return the distance to the nearest circle on each beam, or infinity."""
    dx, dy, radius = circles[:, 0:1] - x, circles[:, 1:2] - y, circles[:, 2:3]
    ahead = along_x * dx + along_y * dy  # way along the beam to its point that is nearest to the middle
    beside = along_x * dy - along_y * dx  # and how far that point is from the middle
    squared = radius * radius - beside * beside
    half_chord = np.sqrt(np.maximum(squared, 0.0))
    hit = (squared >= 0.0) & (ahead + half_chord >= 0.0)
    return np.where(hit, ahead - half_chord, np.inf).min(axis=0)  # below 0 where the place is inside


def _to_boxes(x: float, y: float, along_x: Floats, along_y: Floats, boxes: Floats) -> Floats:
    """Return the distance to the nearest box on each beam, or infinity. Each box is seen in its own frame."""
    cos, sin = boxes[:, 4:5], boxes[:, 5:6]
    dx, dy = boxes[:, 0:1] - x, boxes[:, 1:2] - y
    enter_x, leave_x = _through(dx * cos + dy * sin, boxes[:, 2:3], along_x * cos + along_y * sin + NOT_ZERO)
    enter_y, leave_y = _through(dy * cos - dx * sin, boxes[:, 3:4], along_y * cos - along_x * sin + NOT_ZERO)
    enter, leave = np.maximum(enter_x, enter_y), np.minimum(leave_x, leave_y)
    hit = (enter <= leave) & (leave >= 0.0)
    return np.where(hit, enter, np.inf).min(axis=0)  # below 0 where the place is inside


def _through(middle: Floats, half: Floats, along: Floats) -> tuple[Floats, Floats]:
    """Return where beams enter and leave the strip of a box between two parallel sides."""
    to_middle, to_side = middle / along, half / np.abs(along)
    return to_middle - to_side, to_middle + to_side


def show(shown: dict[tuple[str, int], Marker], message: MarkerArray) -> Obstacles:
    """Bring the shown markers up to date, as a viewer does, and return the obstacles that they stand for.

    An upright CYLINDER is a circle, a CUBE is a box that may be turned; markers of other types are no
    obstacles.
    """
    for marker in message.markers:
        if marker.action == Marker.DELETEALL:
            shown.clear()
        elif marker.action == Marker.DELETE:
            shown.pop((marker.ns, marker.id), None)
        else:
            shown[marker.ns, marker.id] = marker
    circles = [_circle(marker) for marker in shown.values() if marker.type == Marker.CYLINDER]
    boxes = [_box(marker) for marker in shown.values() if marker.type == Marker.CUBE]
    return Obstacles(np.array(circles).reshape(-1, 3), np.array(boxes).reshape(-1, 6))


def _circle(marker: Marker) -> tuple[float, ...]:
    return marker.pose.position.x, marker.pose.position.y, marker.scale.x / 2


def _box(marker: Marker) -> tuple[float, ...]:
    place, turn = marker.pose.position, marker.pose.orientation
    size = turn.w * turn.w + turn.z * turn.z or 1.0  # all zero stands for "not turned", as in a viewer
    cos, sin = 1.0 - 2.0 * turn.z * turn.z / size, 2.0 * turn.w * turn.z / size
    return place.x, place.y, marker.scale.x / 2, marker.scale.y / 2, cos, sin


def _numbers(source: random.Random) -> np.random.RandomState:
    """Return a source of the very same random numbers, from which numpy takes many at once."""
    _, words, _ = source.getstate()
    numbers = np.random.RandomState(0)
    numbers.set_state(("MT19937", np.array(words[:-1], np.uint32), words[-1], 0, 0.0))
    return numbers


class ObstacleDetectorNode(Node):
    """Publishes `/obstacles`, `scan_rate` times a second, from the parameter `source`: mock or world.

    It listens to the turtle and to the obstacles only while it measures, because 62 poses a second are not
    free.
    """

    def __init__(self) -> None:
        super().__init__("obstacle_detector")
        self.add_on_set_parameters_callback(self.on_set_parameters)
        allowed = IntegerRange(from_value=1, to_value=50, step=1)
        self.declare_parameter(
            "scan_rate", 5, ParameterDescriptor(description="Scans a second", integer_range=[allowed])
        )
        self.declare_parameter(
            "source",
            "mock",
            ParameterDescriptor(
                description="mock: made-up readings; world: measured from the turtle's pose",
                additional_constraints="mock or world",
            ),
        )
        self.declare_parameter(
            "seed",
            -1,
            ParameterDescriptor(
                description="The same seed gives the same made-up readings; -1: different ones at each start",
                read_only=True,
            ),
        )
        seed = self.get_parameter("seed").value
        self._random = _numbers(random.Random(random.getrandbits(32) if seed == -1 else seed))
        self._pose: Pose | None = None
        self._ticks_without_pose = 0
        self._markers: dict[tuple[str, int], Marker] = {}
        self._obstacles = NOTHING
        self._ears: list[Subscription] = []
        self._publisher = self.create_publisher(LaserScan, "/obstacles", 10)
        self._timer = self.create_timer(self._period(), self.on_scan_timer)
        self._listen(self._measures())
        self.get_logger().info("Obstacle detector ready, scanning to /obstacles")

    def on_set_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        """Refuse a source that does not exist."""
        for parameter in parameters:
            if parameter.name == "source" and parameter.value not in SOURCES:
                reason = f"source must be 'mock' or 'world', not {parameter.value!r}"
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def on_pose(self, pose: Pose) -> None:
        """Keep the place to measure from."""
        self._pose = pose
        self._ticks_without_pose = 0

    def on_obstacles(self, message: MarkerArray) -> None:
        """Keep what stands in the world."""
        self._obstacles = show(self._markers, message)

    def on_scan_timer(self) -> None:
        """Publish one scan."""
        period, measures = self._period(), self._measures()
        if measures != bool(self._ears):
            self._listen(measures)
        readings = self._measured(period) if measures else self._made_up()
        if readings is not None:
            self._publish(readings, period)
        self._keep_pace(period)

    def _measures(self) -> bool:
        return self.get_parameter("source").value == "world"

    def _listen(self, wanted: bool) -> None:
        """Start to listen to the pose and the obstacles, or stop it and forget them."""
        while self._ears:
            self.destroy_subscription(self._ears.pop())
        self._pose, self._obstacles, self._ticks_without_pose = None, NOTHING, 0
        self._markers.clear()
        if wanted:
            # The obstacles were published long ago, and only once. "Transient local" asks for what was sent
            # before.
            latched = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            self._ears.append(self.create_subscription(MarkerArray, "/world/obstacles", self.on_obstacles, latched))
            self._ears.append(self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 1))

    def _made_up(self) -> array[float]:
        met = self._random.random_sample(BEAMS) < MOCK_SHARE
        return array("f", np.where(met, np.float32(MOCK_DISTANCE), np.float32(RANGE_MAX)).tobytes())

    def _measured(self, period: float) -> array[float] | None:
        """Return the readings from where the turtle is, or None if nobody says where that is."""
        self._ticks_without_pose += 1
        if self._ticks_without_pose * period > PATIENCE:
            self.get_logger().warning(
                f"No scan: no pose heard on /turtle1/pose for {PATIENCE:.0f} s. Is the simulator running? "
                "Start it with: ros2 run turtlesim turtlesim_node",
                throttle_duration_sec=5.0,
            )
            return None
        pose = self._pose
        if pose is None:
            return None
        # An array of the message's own type is taken as it is; a list would be checked number by number.
        return array("f", cast_rays(pose.x, pose.y, pose.theta, self._obstacles).tobytes())

    def _publish(self, readings: array[float], period: float) -> None:
        scan = LaserScan()
        scan.header.stamp = self.get_clock().now().to_msg()
        scan.header.frame_id = "base_link"
        scan.angle_min, scan.angle_max = -math.pi / 2, math.pi / 2
        scan.angle_increment = math.pi / (BEAMS - 1)
        scan.scan_time = period  # time_increment stays 0: all beams are taken at one instant
        scan.range_min, scan.range_max = 0.0, RANGE_MAX
        scan.ranges = readings
        self._publisher.publish(scan)

    def _period(self) -> float:
        return 1.0 / self.get_parameter("scan_rate").value

    def _keep_pace(self, period: float) -> None:
        """Re-time the timer if `scan_rate` was changed since the last tick."""
        nanoseconds = round(1e9 * period)
        if self._timer.timer_period_ns != nanoseconds:
            self._timer.timer_period_ns = nanoseconds
            self._timer.reset()


def main(args: list[str] | None = None) -> None:
    """Run the node until it is interrupted: what `ros2 run robot_controller obstacle_detector` does."""
    rclpy.init(args=args)
    node = ObstacleDetectorNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
