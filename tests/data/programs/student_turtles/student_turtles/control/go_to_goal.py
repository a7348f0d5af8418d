from __future__ import annotations

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose

from student_tools import PID, normalize

from .. import goals
from ..goals import Goal


class GoToGoal(Node):
    def __init__(self) -> None:
        super().__init__('go_to_goal')
        self.declare_parameter('tolerance', 0.1)
        self.goals: list[Goal] = goals.load()
        self.turn, self.drive = PID(kp=4.0), PID(kp=1.0, kd=0.1)
        self.pose: Pose | None = None
        self.publisher = self.create_publisher(Twist, 'turtle1/cmd_vel', 10)
        self.create_subscription(Pose, 'turtle1/pose', lambda msg: setattr(self, 'pose', msg), 10)
        self.period = 0.02
        self.create_timer(self.period, self.control)

    def control(self) -> None:
        if self.pose is None or not self.goals:
            return
        goal = self.goals[0]
        dx, dy = goal.x - self.pose.x, goal.y - self.pose.y
        if math.hypot(dx, dy) < self.get_parameter('tolerance').value:
            self.get_logger().info(f'at {goal}')
            self.goals.pop(0)
            self.publisher.publish(Twist())
            if not self.goals:
                raise SystemExit(0)
            return
        cmd = Twist()
        error = normalize(math.atan2(dy, dx) - self.pose.theta)
        cmd.angular.z = self.turn(error, self.period)
        cmd.linear.x = self.drive(math.hypot(dx, dy), self.period) * max(0.0, math.cos(error))
        self.publisher.publish(cmd)


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(GoToGoal())
