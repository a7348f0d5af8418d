"""A client that goes step by step, and spins while it waits."""

import rclpy
from rclpy.action import ActionClient
from workshop_interfaces.action import Countdown


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("plain_client")
    client = ActionClient(node, Countdown, "countdown")
    client.wait_for_server()

    future = client.send_goal_async(
        Countdown.Goal(start=2), feedback_callback=lambda message: print("feedback", message.feedback.left)
    )
    rclpy.spin_until_future_complete(node, future)
    goal_handle = future.result()
    print("accepted", goal_handle.accepted)

    future = goal_handle.get_result_async()
    rclpy.spin_until_future_complete(node, future)
    print("result", list(future.result().result.counted), "status", future.result().status)

    client.destroy()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
