"""A server as the tutorial has it: one thread, so a goal that is being reached holds up all else."""

import time

import rclpy
from rclpy.action import ActionServer
from rclpy.node import Node
from workshop_interfaces.action import Countdown


class SimpleServer(Node):
    def __init__(self):
        super().__init__("simple_server")
        self._server = ActionServer(self, Countdown, "countdown", self.execute_callback)

    def execute_callback(self, goal_handle):
        self.get_logger().info("Executing goal...")
        feedback = Countdown.Feedback()
        counted = []
        for left in range(goal_handle.request.start, 0, -1):
            counted.append(left)
            feedback.left = left
            goal_handle.publish_feedback(feedback)
            time.sleep(1)
        goal_handle.succeed()
        result = Countdown.Result()
        result.counted = counted
        return result


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(SimpleServer())


if __name__ == "__main__":
    main()
