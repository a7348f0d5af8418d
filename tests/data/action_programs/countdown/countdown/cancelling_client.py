"""A client that changes its mind after two and a half seconds."""

import rclpy

from countdown.client import CountdownClient


class CancellingClient(CountdownClient):
    def goal_response_callback(self, future):
        super().goal_response_callback(future)
        self._timer = self.create_timer(2.5, self.change_mind)

    def change_mind(self):
        self._timer.cancel()
        self.get_logger().info("Canceling goal")
        self._goal_handle.cancel_goal_async().add_done_callback(self.cancel_done)

    def cancel_done(self, future):
        canceled = len(future.result().goals_canceling) > 0
        self.get_logger().info("Goal is being canceled" if canceled else "Goal failed to cancel")


def main(args=None):
    rclpy.init(args=args)
    client = CancellingClient("cancelling_client")
    client.send_goal(5)
    rclpy.spin(client)


if __name__ == "__main__":
    main()
