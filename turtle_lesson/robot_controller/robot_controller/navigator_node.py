#!/usr/bin/env python3
"""The navigator: drives the turtle to a goal pose and says whether it got there.

Run it with `ros2 run robot_controller navigator`, then ask, for example:

    ros2 service call /navigate_to robot_controller/srv/NavigateTo "{x: 8.0, y: 3.0, theta: 1.57}"

It closes the loop: ten times a second a timer compares the newest pose with the goal, and sends the next
command.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple, Protocol

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from rclpy.time import Time
from robot_controller.srv import NavigateTo
from sensor_msgs.msg import LaserScan

try:
    from turtlesim.msg import Pose
except ImportError:  # ROS 2 Kilted and newer keep turtlesim's messages in a package of their own
    from turtlesim_msgs.msg import Pose

WORLD_SIZE = 11.088889
"""Side of turtlesim's square world, m."""

STEERING_PERIOD = 0.1
"""Time between two commands, s. The gains below are sized for it."""

DRIVE_GAIN = 4.0
TURN_GAIN = 5.0
"""Speed for each metre of distance, and turning speed for each radian of error, 1/s.

One command takes away 0.4 of the distance and half of the angle. So the turtle comes to rest without swinging
if commands take effect within 0.03 s, and still comes to rest if they are late by a whole period.
"""

DRIVE_CONE = 0.5
"""The turtle drives while it faces the goal this well, rad; otherwise it turns on the spot."""

ABOUT_TURN = 1.5
"""Beyond this angle, rad, a turn goes on the way round that it began, even if the other is shorter by now.

Without that, a turtle that has to turn about could swing for ever: each late command carries it across the
point where the other way round is the shorter one, and the next command calls it back.
"""

AIM = 0.25
"""Steering goes on until the errors are this part of their tolerances: a late command may still add some."""

PATIENCE = 1.0
"""Without a pose for so long, s, there is no turtle to drive."""


class Place(Protocol):
    """Anything with a position in metres and a heading in radians: a pose, a request, a goal."""

    x: float
    y: float
    theta: float


class Limits(NamedTuple):
    """What a drive must keep to: highest speeds (m/s, rad/s), and how near is near enough (m, rad)."""

    linear_speed: float
    angular_speed: float
    goal_tolerance: float
    heading_tolerance: float


class Phase(Enum):
    """What the turtle is doing on its way."""

    TURN = "turning towards the goal"
    DRIVE = "driving to the goal"
    ALIGN = "turning to the goal's heading"
    THERE = "there"


class Command(NamedTuple):
    """Speed forwards (m/s), turning speed (rad/s, anticlockwise), and the phase they belong to."""

    linear: float
    angular: float
    phase: Phase


def wrap(angle: float) -> float:
    """Return the same direction as an angle in [-pi, pi]: the short way round, also across due west."""
    return math.remainder(angle, math.tau)


def errors(pose: Place, goal: Place) -> tuple[float, float]:
    """Return how far the goal is (m), and the angle by which the heading still has to turn (rad, signed)."""
    return math.hypot(goal.x - pose.x, goal.y - pose.y), wrap(goal.theta - pose.theta)


def reached(pose: Place, goal: Place, limits: Limits) -> bool:
    """Is this pose within both tolerances of the goal?"""
    distance, turn = errors(pose, goal)
    return distance <= limits.goal_tolerance and abs(turn) <= limits.heading_tolerance


def steer(pose: Place, goal: Place, limits: Limits, turning: float = 0.0) -> Command:
    """Return the next command on the way from a pose to a goal: turn, drive, then turn to the goal's heading.

    Where the turtle is decides what comes next, so that it also recovers from being moved. All that it is
    told of the past is `turning`, the turning speed of the command before.
    """
    distance, turn = errors(pose, goal)
    if distance > AIM * limits.goal_tolerance:
        return _approach(pose, goal, limits, turning)
    if abs(turn) > AIM * limits.heading_tolerance:
        return Command(0.0, turning_speed(turn, limits, turning), Phase.ALIGN)
    return Command(0.0, 0.0, Phase.THERE)


def _approach(pose: Place, goal: Place, limits: Limits, turning: float) -> Command:
    dx, dy = goal.x - pose.x, goal.y - pose.y
    distance, turn = math.hypot(dx, dy), wrap(math.atan2(dy, dx) - pose.theta)
    angular = turning_speed(turn, limits, turning)
    if abs(turn) > DRIVE_CONE:
        return Command(0.0, angular, Phase.TURN)
    linear = min(DRIVE_GAIN * distance, limits.linear_speed)
    # Too fast past a goal that is still to one side, and the turtle circles it: it has to turn to it first.
    sideways, bearable = linear * abs(math.sin(turn)), 0.5 * limits.angular_speed * distance
    if sideways > bearable:
        linear *= bearable / sideways
    return Command(linear, angular, Phase.DRIVE)


def turning_speed(turn: float, limits: Limits, turning: float) -> float:
    """Return how fast to turn by an angle in [-pi, pi], when the turtle is turning already, or not (0)."""
    if abs(turn) > ABOUT_TURN and turn * turning < 0.0:
        turn = -turn  # the long way: its size does not matter, being far beyond what full speed is for
    return max(-limits.angular_speed, min(limits.angular_speed, TURN_GAIN * turn))


def refusal(goal: Place) -> str | None:
    """Return why the turtle cannot go to a goal, or None if it can."""
    if not all(map(math.isfinite, (goal.x, goal.y, goal.theta))):
        return f"x={goal.x}, y={goal.y}, theta={goal.theta} is not a pose: all three must be finite numbers"
    beyond = WORLD_SIZE + 1e-5  # the wall itself, rounded to float32 as messages are, is a little beyond
    if not (0.0 <= goal.x <= beyond and 0.0 <= goal.y <= beyond):
        where = f"({goal.x:.2f}, {goal.y:.2f})"
        return f"{where} is outside the world: x and y must be from 0 to {WORLD_SIZE:.2f}"
    return None


def nearest(scan: LaserScan, within: float) -> float | None:
    """Return the smallest valid reading that is below a distance in metres, or None if there is none."""
    low, high = scan.range_min, min(within, scan.range_max)
    return min([reading for reading in scan.ranges if reading < high and reading >= low], default=None)


@dataclass
class Drive:
    """A goal under way. Its future is given True or False, reached or not, when the drive has ended."""

    goal: Place
    ended: Future = field(default_factory=Future)
    started: Time | None = None  # when the first command went out
    stopped: Time | None = None  # when the turtle was told to stand still
    turning: float = 0.0  # the turning speed of the last command

    @property
    def seconds(self) -> float:
        """How long the turtle was moving."""
        if self.started is None or self.stopped is None:
            return 0.0
        return (self.stopped - self.started).nanoseconds / 1e9


PARAMETERS = (
    ("goal_timeout", 10.0, 0.1, 3600.0, "Longest time that a goal may take, s; the launch file sets 5.0"),
    ("linear_speed", 4.0, 0.01, 10.0, "Highest speed, m/s; it comes down near the goal"),
    ("angular_speed", 6.0, 0.01, 10.0, "Highest turning speed, rad/s"),
    ("goal_tolerance", 0.2, 0.01, 2.0, "A goal counts as reached within this distance, m"),
    ("heading_tolerance", 0.1, 0.01, math.pi, "A goal counts as reached within this angle, rad"),
    ("obstacle_warning_distance", 0.4, 0.0, 10.0, "Warn of obstacles nearer than this, m; mock scans show 0.5"),
)
"""Name, default, lowest and highest value, description. Read when used: `ros2 param set` works at once."""


class NavigatorNode(Node):
    """Offers `/navigate_to`; listens to the turtle's pose and to the scan; commands the turtle.

    The service's callback waits for its drive to end, and a callback group stays taken while one of its
    callbacks waits. So the service has a group of its own, a reentrant one: poses and steering go on
    meanwhile, and a second request is heard (and refused) at once.
    """

    def __init__(self) -> None:
        super().__init__("navigator")
        for name, default, low, high, text in PARAMETERS:
            allowed = FloatingPointRange(from_value=low, to_value=high)
            self.declare_parameter(name, default, ParameterDescriptor(description=text, floating_point_range=[allowed]))
        self._pose: Pose | None = None
        self._ticks_without_pose = 0
        self._drive: Drive | None = None
        self._obstacle_near = False
        self._commands = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 1)  # only the newest pose is of use
        # Real laser scanners publish "best effort". This profile hears those, and reliable publishers, too.
        self.create_subscription(LaserScan, "/obstacles", self.on_scan, qos_profile_sensor_data)
        self.create_service(NavigateTo, "/navigate_to", self.on_navigate_to, callback_group=ReentrantCallbackGroup())
        # The timer also runs while there is nothing to do, because Python notices a Ctrl-C only when rclpy
        # returns from waiting, and it might wait for ever where nothing happens.
        self._timer = self.create_timer(STEERING_PERIOD, self.on_steering_timer)
        self.get_logger().info("Navigator ready for goals on /navigate_to")

    def on_pose(self, pose: Pose) -> None:
        """Keep the newest pose for the next tick of the timer."""
        self._pose = pose
        self._ticks_without_pose = 0

    def on_scan(self, scan: LaserScan) -> None:
        """Warn of what is near: repeatedly while driving, once while standing. The path stays the same."""
        distance = nearest(scan, within=self._value("obstacle_warning_distance"))
        if distance is not None and (self._drive is not None or not self._obstacle_near):
            self.get_logger().warning(f"Obstacle {distance:.2f} m away", throttle_duration_sec=2.0)
        self._obstacle_near = distance is not None

    async def on_navigate_to(self, request: NavigateTo.Request, response: NavigateTo.Response) -> NavigateTo.Response:
        """Start a drive and answer when it has ended; refuse at once what cannot be done."""
        reason = self._busy() or refusal(request)
        if reason is not None:
            self.get_logger().warning(f"Goal refused: {reason}")
            return response  # as it came: success is False, time_taken 0.0
        self.get_logger().info(
            f"Goal accepted: x {request.x:.2f} m, y {request.y:.2f} m, "
            f"theta {request.theta:.2f} rad ({math.degrees(request.theta):.0f}°)"
        )
        self._drive = drive = Drive(request)
        self._timer.reset()  # a whole period from here to the second command
        self._continue(drive)
        response.success = await drive.ended
        response.time_taken = drive.seconds
        return response

    def on_steering_timer(self) -> None:
        """Go on with the drive that is under way, if any."""
        self._ticks_without_pose += 1
        if self._drive is not None:
            self._continue(self._drive)

    def stop(self) -> None:
        """Leave no turtle driving: stop it if a goal is under way."""
        if self._drive is not None and self.context.ok():
            self._send(0.0, 0.0)

    def _continue(self, drive: Drive) -> None:
        """Do what is next. Without news of the turtle since the last tick it must not move."""
        pose = self._pose
        if pose is None or self._ticks_without_pose > 1:
            self._wait_for_pose(drive)
        elif drive.stopped is None:
            self._move(drive, pose)
        else:
            self._judge(drive, pose)

    def _value(self, name: str) -> float:
        return self.get_parameter(name).value

    def _limits(self) -> Limits:
        return Limits(*map(self._value, Limits._fields))

    def _busy(self) -> str | None:
        if self._drive is None:
            return None
        goal = self._drive.goal
        return f"still on the way to ({goal.x:.2f}, {goal.y:.2f}); ask again when that goal has been answered"

    def _send(self, linear: float, angular: float) -> None:
        command = Twist()
        command.linear.x = round(linear, 6)  # fine enough, and easier to read in an echo
        command.angular.z = round(angular, 6)
        self._commands.publish(command)

    def _wait_for_pose(self, drive: Drive) -> None:
        if drive.started is not None:
            self._send(0.0, 0.0)
        if self._ticks_without_pose * STEERING_PERIOD > PATIENCE:
            self.get_logger().error(
                f"Goal given up: no pose heard on /turtle1/pose for {PATIENCE:.0f} s. "
                "Is the simulator running? Start it with: ros2 run turtlesim turtlesim_node"
            )
            drive.stopped = drive.stopped or self.get_clock().now()
            self._end(drive, False)

    def _move(self, drive: Drive, pose: Pose) -> None:
        """Send the next command, or stop the turtle if it is there or its time is over."""
        now = self.get_clock().now()
        drive.started = drive.started or now
        command = steer(pose, drive.goal, self._limits(), drive.turning)
        drive.turning = command.angular
        if command.phase is Phase.THERE or self._time_over(drive, now):
            drive.stopped = now
            self._send(0.0, 0.0)
        else:
            self._send(command.linear, command.angular)

    def _judge(self, drive: Drive, pose: Pose) -> None:
        """The turtle is at rest. Say how it went, or go on if it is not near enough and there is time."""
        limits = self._limits()
        success = reached(pose, drive.goal, limits)
        if not success and not self._time_over(drive, self.get_clock().now()):
            drive.stopped = None
            self._move(drive, pose)
            return
        distance, turn = errors(pose, drive.goal)
        report = f"{distance:.2f} m and {abs(turn):.2f} rad from it after {drive.seconds:.1f} s"
        if success:
            self.get_logger().info(f"Goal reached: {report}")
        else:
            self.get_logger().warning(
                f"Goal not reached: {report}. That is all the time goal_timeout gives "
                f"({self._value('goal_timeout'):.1f} s); a longer one or a higher linear_speed may help"
            )
        self._end(drive, success)

    def _time_over(self, drive: Drive, now: Time) -> bool:
        """Is this tick the one nearest to the timeout, or past it?"""
        elapsed = (now - drive.started).nanoseconds / 1e9 if drive.started is not None else 0.0
        return elapsed > self._value("goal_timeout") - STEERING_PERIOD / 2

    def _end(self, drive: Drive, success: bool) -> None:
        self._drive = None
        drive.ended.set_result(success)  # on_navigate_to, which waits for this, now answers


def main(args: list[str] | None = None) -> None:
    """Run the node until it is interrupted: what `ros2 run robot_controller navigator` does."""
    # With its usual signal handlers rclpy shuts down before the KeyboardInterrupt arrives here, and a node
    # that is shut down can no longer stop the turtle. Without them the last command still goes out.
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    node = NavigatorNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.stop()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
