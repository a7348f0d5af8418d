"""A state machine in a loop of its own, with arguments."""
import argparse
import sys
from enum import Enum, auto

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from turtlesim.msg import Pose


class State(Enum):
    WAIT = auto()
    DRIVE = auto()
    TURN = auto()
    STOP = auto()


class Machine(Node):
    def __init__(self, sides):
        super().__init__('machine')
        self.state = State.WAIT
        self.sides = sides
        self.pose = None
        self.since = self.get_clock().now()
        self.pub = self.create_publisher(Twist, 'turtle1/cmd_vel', 10)
        self.sub = self.create_subscription(Pose, 'turtle1/pose', self.on_pose, 10)

    def on_pose(self, pose):
        self.pose = pose

    def go(self, state):
        self.get_logger().info(f'{self.state.name} -> {state.name}')
        self.state, self.since = state, self.get_clock().now()

    def step(self):
        passed = (self.get_clock().now() - self.since).nanoseconds / 1e9
        if self.state is State.WAIT and self.pose is not None:
            self.go(State.DRIVE)
        elif self.state is State.DRIVE:
            self.pub.publish(Twist())
            if passed > 1.0:
                self.go(State.TURN)
        elif self.state is State.TURN and passed > 0.5:
            self.sides -= 1
            self.go(State.DRIVE if self.sides else State.STOP)


def main(argv=None):
    argv = remove_ros_args(args=argv if argv is not None else sys.argv)
    parser = argparse.ArgumentParser(prog='spin_once', description='drives a polygon')
    parser.add_argument('-n', '--sides', type=int, default=4)
    parser.add_argument('--verbose', action='store_true')
    args = parser.parse_args(argv[1:])
    rclpy.init()
    machine = Machine(args.sides)
    try:
        while rclpy.ok() and machine.state is not State.STOP:
            rclpy.spin_once(machine, timeout_sec=0.1)
            machine.step()
    except (KeyboardInterrupt, ExternalShutdownException):
        print('stopped by the user')
    finally:
        machine.destroy_node()
        rclpy.try_shutdown()
    return 0 if machine.state is State.STOP else 3


if __name__ == '__main__':
    sys.exit(main())
