"""A node that is both: it offers `double_countdown`, and has `countdown` count down twice for it."""

import rclpy
from rclpy.action import ActionClient, ActionServer
from rclpy.node import Node
from workshop_interfaces.action import Countdown


class Relay(Node):
    def __init__(self):
        super().__init__("relay")
        self._client = ActionClient(self, Countdown, "countdown")
        self._server = ActionServer(self, Countdown, "double_countdown", self.execute_callback)

    async def execute_callback(self, goal_handle):
        result = Countdown.Result()
        for _ in range(2):
            goal = await self._client.send_goal_async(goal_handle.request, feedback_callback=self.on_feedback)
            answer = await goal.get_result_async()
            result.counted.extend(answer.result.counted)
        goal_handle.succeed()
        return result

    def on_feedback(self, message):
        self.get_logger().info(f"{message.feedback.left} left")


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Relay())


if __name__ == "__main__":
    main()
