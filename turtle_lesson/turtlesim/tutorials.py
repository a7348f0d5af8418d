"""Two programs of turtlesim's, in plain ``rclpy``: `ros2 run turtlesim draw_square` and `ros2 run turtlesim mimic`.

Facts: ros_tutorials, turtlesim/tutorials/draw_square.cpp of Kilted and newer (Humble's has a mistake: it stops after its first
goal, which it reckons from (0, 0)), and mimic.cpp.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from enum import Enum, auto

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_srvs.srv import Empty
from turtlesim.msg import Pose

PERIOD = 0.016
SIDE = 2.0
SPEED, TURN_SPEED = 1.0, 0.4
NEAR, ALIGNED, STILL = 0.1, 0.01, 0.0001


class State(Enum):
    """What the turtle is about."""

    FORWARD = auto()
    STOP_FORWARD = auto()
    TURN = auto()
    STOP_TURN = auto()


class DrawSquare(Node):
    """The turtle walks along a square, one side after the other, driven by what is heard of its pose."""

    def __init__(self) -> None:
        super().__init__("draw_square")
        self._pose: Pose | None = None
        self._goal: Pose | None = None
        self._state = State.FORWARD
        self._publisher = self.create_publisher(Twist, "turtle1/cmd_vel", 1)
        self.create_subscription(Pose, "turtle1/pose", self._on_pose, 1)
        self.create_timer(PERIOD, self._step)
        self.create_client(Empty, "reset").call_async(Empty.Request())

    def _on_pose(self, pose: Pose) -> None:
        self._pose = pose

    def _step(self) -> None:
        if self._pose is None:
            return
        if self._goal is None:
            self._aim(self._ahead(self._pose))
        match self._state:
            case State.FORWARD:
                self._go_on(SPEED, 0.0, State.STOP_FORWARD)
            case State.TURN:
                self._go_on(0.0, TURN_SPEED, State.STOP_TURN)
            case State.STOP_FORWARD:
                self._stop(State.TURN, self._turned(self._pose))
            case State.STOP_TURN:
                self._stop(State.FORWARD, self._ahead(self._pose))

    @staticmethod
    def _ahead(pose: Pose) -> Pose:
        x, y = pose.x + SIDE * math.cos(pose.theta), pose.y + SIDE * math.sin(pose.theta)
        return Pose(x=x, y=y, theta=pose.theta)

    @staticmethod
    def _turned(pose: Pose) -> Pose:
        theta = math.remainder(pose.theta + math.pi / 2.0, 2.0 * math.pi)
        return Pose(x=pose.x, y=pose.y, theta=theta)

    def _aim(self, goal: Pose) -> None:
        self._goal = goal
        self.get_logger().info(f"New goal [{goal.x:f} {goal.y:f}, {goal.theta:f}]")

    def _there(self) -> bool:
        pose, goal = self._pose, self._goal
        assert pose is not None and goal is not None
        near = abs(pose.x - goal.x) < NEAR and abs(pose.y - goal.y) < NEAR
        return near and abs(math.remainder(pose.theta - goal.theta, 2.0 * math.pi)) < ALIGNED

    def _go_on(self, speed: float, turn: float, when_there: State) -> None:
        if self._there():
            self._state = when_there
            speed = turn = 0.0
        self._command(speed, turn)

    def _stop(self, then: State, goal: Pose) -> None:
        assert self._pose is not None
        if self._pose.angular_velocity < STILL and self._pose.linear_velocity < STILL:
            self.get_logger().info("Reached goal")
            self._state = then
            self._aim(goal)
        else:
            self._command(0.0, 0.0)

    def _command(self, speed: float, turn: float) -> None:
        message = Twist()
        message.linear.x, message.angular.z = speed, turn
        self._publisher.publish(message)


class Mimic(Node):
    """One turtle does what another one does: passes the speeds of its pose on as a command.

    `ros2 run turtlesim mimic --ros-args -r input/pose:=turtle1/pose -r output/cmd_vel:=turtle2/cmd_vel`
    """

    def __init__(self) -> None:
        super().__init__("turtle_mimic")
        self._publisher = self.create_publisher(Twist, "output/cmd_vel", 1)
        self.create_subscription(Pose, "input/pose", self._on_pose, 1)

    def _on_pose(self, pose: Pose) -> None:
        message = Twist()
        message.linear.x, message.angular.z = pose.linear_velocity, pose.angular_velocity
        self._publisher.publish(message)


def draw_square() -> None:
    """Run until Ctrl-C."""
    _run(DrawSquare)


def mimic() -> None:
    """Run until Ctrl-C."""
    _run(Mimic)


def _run(make_node: Callable[[], Node]) -> None:
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(make_node())
