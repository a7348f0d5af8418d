from abc import ABC, abstractmethod
from collections import deque
from typing import Callable

import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose

SUCCESS, FAILURE, RUNNING = 'SUCCESS', 'FAILURE', 'RUNNING'


class Behaviour(ABC):
    @abstractmethod
    def tick(self) -> str:
        ...


class Sequence(Behaviour):
    def __init__(self, *children: Behaviour) -> None:
        self.children, self.at = children, 0

    def tick(self) -> str:
        while self.at < len(self.children):
            status = self.children[self.at].tick()
            if status != SUCCESS:
                return status
            self.at += 1
        return SUCCESS


class Selector(Behaviour):
    def __init__(self, *children: Behaviour) -> None:
        self.children = children

    def tick(self) -> str:
        for child in self.children:
            if (status := child.tick()) != FAILURE:
                return status
        return FAILURE


class Condition(Behaviour):
    def __init__(self, test: Callable[[], bool]) -> None:
        self.test = test

    def tick(self) -> str:
        return SUCCESS if self.test() else FAILURE


class Drive(Behaviour):
    def __init__(self, node: Node, v: float, w: float) -> None:
        self.node, self.v, self.w = node, v, w

    def tick(self) -> str:
        msg = Twist()
        msg.linear.x, msg.angular.z = self.v, self.w
        self.node.pub.publish(msg)
        return RUNNING


class TreeNode(Node):
    def __init__(self):
        super().__init__('tree')
        self.pub = self.create_publisher(Twist, 'turtle1/cmd_vel', 10)
        self.create_subscription(Pose, 'turtle1/pose', self.on_pose, 10)
        self.poses = deque(maxlen=5)
        self.root = Sequence(
            Condition(lambda: True),
            Selector(Condition(lambda: bool(self.poses) and self.poses[-1].x > 8.0), Drive(self, 2.0, 0.0)),
            Selector(Condition(lambda: abs(self.poses[-1].theta) > 1.0), Drive(self, 0.0, 1.0)),
        )
        self.timer = self.create_timer(0.1, self.tick)

    def on_pose(self, msg):
        self.poses.append(msg)

    def tick(self):
        if self.root.tick() == SUCCESS:
            last = self.poses[-1]
            self.get_logger().info('done at x %.1f theta %.1f' % (last.x, last.theta))
            self.timer.cancel()
            rclpy.shutdown()


def main():
    rclpy.init()
    try:
        rclpy.spin(TreeNode())
    except rclpy.executors.ExternalShutdownException:
        print('shut down from inside')
