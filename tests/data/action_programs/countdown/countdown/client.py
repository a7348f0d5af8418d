"""A client that goes from callback to callback."""

import sys

import rclpy
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.node import Node
from workshop_interfaces.action import Countdown


class CountdownClient(Node):
    def __init__(self, name="client"):
        super().__init__(name)
        self._client = ActionClient(self, Countdown, "countdown")

    def send_goal(self, start):
        self.get_logger().info("Waiting for the action server...")
        self._client.wait_for_server()
        goal = Countdown.Goal()
        goal.start = start
        future = self._client.send_goal_async(goal, feedback_callback=self.feedback_callback)
        future.add_done_callback(self.goal_response_callback)

    def goal_response_callback(self, future):
        self._goal_handle = future.result()
        if not self._goal_handle.accepted:
            self.get_logger().info("Goal rejected :(")
            rclpy.shutdown()
            return
        self.get_logger().info("Goal accepted :)")
        self._goal_handle.get_result_async().add_done_callback(self.get_result_callback)

    def feedback_callback(self, feedback_msg):
        self.get_logger().info(f"{feedback_msg.feedback.left} left")

    def get_result_callback(self, future):
        answer = future.result()
        if answer.status == GoalStatus.STATUS_SUCCEEDED:
            self.get_logger().info(f"Goal succeeded: {list(answer.result.counted)}")
        else:
            self.get_logger().info(f"Goal failed with status {answer.status}: {list(answer.result.counted)}")
        rclpy.shutdown()


def main(args=None):
    rclpy.init(args=args)
    client = CountdownClient()
    client.send_goal(int(sys.argv[1]))
    rclpy.spin(client)


if __name__ == "__main__":
    main()
