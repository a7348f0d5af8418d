#!/usr/bin/env python3
"""The status monitor: reports where the turtle is, how it moves, and how full its battery is.

Run it with `ros2 run robot_controller status_monitor`, and watch it with `ros2 topic echo /robot/status`.
"""

from __future__ import annotations

import math

import rclpy
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from robot_controller.msg import TurtleStatus

try:
    from turtlesim.msg import Pose
except ImportError:  # ROS 2 Kilted and newer keep turtlesim's messages in a package of their own
    from turtlesim_msgs.msg import Pose

SIMULATOR_STEP = 0.016
"""Time between two poses, s. Turtlesim moves by exactly this step, however late a message arrives."""

FULL_BATTERY = 1000
"""Charge at the start, in tenths of a percent: whole numbers add up without rounding. A status uses one."""

PATIENCE = 1.0
"""Without a pose for so long, s, the turtle is reported as lost."""


def world_velocity(before: Pose, now: Pose) -> tuple[float, float]:
    """Return the velocity along the world's axes, m/s, between two poses that follow each other.

    A pose tells its speed without a direction: driving backwards or sideways looks the same, and a turtle
    that pushes against a wall claims to be moving. So the velocity comes from the way between the poses. The
    speed that the pose tells is only its upper limit, for the case that a pose was missed or the turtle was
    teleported.
    """
    dx, dy = now.x - before.x, now.y - before.y
    way = math.hypot(dx, dy)
    if way == 0.0:
        return 0.0, 0.0
    speed = min(way / SIMULATOR_STEP, now.linear_velocity)
    return speed * dx / way, speed * dy / way


class StatusMonitorNode(Node):
    """Publishes `/robot/status` at the rate of the parameter `publish_rate`, from the poses it has heard.

    It publishes from the start, so that the status is also a sign of life. Until the first pose is heard all
    but the battery is zero; when poses stop coming the velocity is; and the log says so.
    """

    def __init__(self) -> None:
        super().__init__("status_monitor")
        allowed = IntegerRange(from_value=1, to_value=100, step=1)
        self.declare_parameter(
            "publish_rate", 10, ParameterDescriptor(description="Statuses a second", integer_range=[allowed])
        )
        self._before: Pose | None = None
        self._pose: Pose | None = None
        self._ticks_without_pose = 0
        self._charge = FULL_BATTERY
        self._publisher = self.create_publisher(TurtleStatus, "/robot/status", 10)
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)
        self._timer = self.create_timer(self._period(), self.on_publish_timer)
        self.get_logger().info("Status monitor ready, reporting on /robot/status")

    def on_pose(self, pose: Pose) -> None:
        """Keep the newest two poses: where the turtle is, and where it came from."""
        self._before, self._pose = self._pose, pose
        self._ticks_without_pose = 0

    def on_publish_timer(self) -> None:
        """Publish one status, and use up a little of the battery."""
        period = self._period()
        self._ticks_without_pose += 1
        lost = self._ticks_without_pose * period > PATIENCE
        self._publisher.publish(self._status(lost))
        self._charge = max(0, self._charge - 1)
        if lost:
            self.get_logger().warning(
                f"No pose heard on /turtle1/pose for {PATIENCE:.0f} s: is the simulator running? "
                "Start it with: ros2 run turtlesim turtlesim_node",
                throttle_duration_sec=5.0,
            )
        self._keep_pace(period)

    def _status(self, lost: bool) -> TurtleStatus:
        status = TurtleStatus(battery=self._charge / 10)
        if self._pose is not None:
            status.x, status.y, status.theta = self._pose.x, self._pose.y, self._pose.theta
            if self._before is not None and not lost:
                status.vel_x, status.vel_y = world_velocity(self._before, self._pose)
        return status

    def _period(self) -> float:
        return 1.0 / self.get_parameter("publish_rate").value

    def _keep_pace(self, period: float) -> None:
        """Re-time the timer if `publish_rate` was changed since the last tick."""
        nanoseconds = round(1e9 * period)
        if self._timer.timer_period_ns != nanoseconds:
            self._timer.timer_period_ns = nanoseconds
            self._timer.reset()


def main(args: list[str] | None = None) -> None:
    """Run the node until it is interrupted: what `ros2 run robot_controller status_monitor` does."""
    rclpy.init(args=args)
    node = StatusMonitorNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
