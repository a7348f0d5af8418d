"""A server that reaches several goals side by side, and lets them be cancelled."""

import time

import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from workshop_interfaces.action import Countdown


class CountdownServer(Node):
    """What the other servers are made of, too."""

    def __init__(self, name="parallel_server", **callbacks):
        super().__init__(name)
        self._server = ActionServer(
            self,
            Countdown,
            "countdown",
            execute_callback=self.execute_callback,
            goal_callback=self.goal_callback,
            cancel_callback=self.cancel_callback,
            callback_group=ReentrantCallbackGroup(),
            **callbacks,
        )

    def destroy_node(self):
        self._server.destroy()
        super().destroy_node()

    def goal_callback(self, goal_request):
        possible = 0 < goal_request.start <= 10
        self.get_logger().info(f"Goal {goal_request.start}: {'accepted' if possible else 'rejected'}")
        return GoalResponse.ACCEPT if possible else GoalResponse.REJECT

    def cancel_callback(self, goal_handle):
        self.get_logger().info(f"Cancel goal {goal_handle.request.start}")
        return CancelResponse.ACCEPT

    def execute_callback(self, goal_handle):
        start = goal_handle.request.start
        self.get_logger().info(f"Count down from {start}")
        result = Countdown.Result()
        for left in range(start, 0, -1):
            if not goal_handle.is_active:
                self.get_logger().info(f"Goal {start} was given up at {left}")
                return result
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                self.get_logger().info(f"Goal {start} canceled at {left}")
                return result
            result.counted.append(left)
            goal_handle.publish_feedback(Countdown.Feedback(left=left))
            time.sleep(1)
        goal_handle.succeed()
        self.get_logger().info(f"Goal {start} reached")
        return result


def run(make, args):
    rclpy.init(args=args)
    try:
        rclpy.spin(make(), executor=MultiThreadedExecutor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


def main(args=None):
    run(CountdownServer, args)


if __name__ == "__main__":
    main()
