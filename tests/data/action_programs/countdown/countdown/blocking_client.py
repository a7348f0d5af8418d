"""A client that waits in its main thread, while another thread spins."""

import threading

import rclpy
from rclpy.action import ActionClient
from workshop_interfaces.action import Countdown


def spin(node):
    rclpy.spin(node)
    print("shut down")


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("blocking_client")
    client = ActionClient(node, Countdown, "countdown")
    thread = threading.Thread(target=spin, args=(node,))
    thread.start()
    client.wait_for_server()
    answer = client.send_goal(
        Countdown.Goal(start=2), feedback_callback=lambda message: print("feedback", message.feedback.left)
    )
    print("result", list(answer.result.counted), "status", answer.status)
    rclpy.shutdown()
    thread.join()


if __name__ == "__main__":
    main()
