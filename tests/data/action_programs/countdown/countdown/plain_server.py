"""A server made of functions, whose `async` callback leaves the only thread to others while it waits."""

import rclpy
from rclpy.action import ActionServer, CancelResponse
from rclpy.task import Future
from workshop_interfaces.action import Countdown

node = None


def cancel_callback(goal_handle):
    node.get_logger().info("Received cancel request")
    return CancelResponse.ACCEPT


def pause(seconds):
    """A future that is done after some seconds."""
    future = Future()

    def end():
        timer.cancel()
        node.destroy_timer(timer)
        future.set_result(None)

    timer = node.create_timer(seconds, end)
    return future


async def execute_callback(goal_handle):
    result = Countdown.Result()
    for left in range(goal_handle.request.start, 0, -1):
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
            return result
        result.counted.append(left)
        goal_handle.publish_feedback(Countdown.Feedback(left=left))
        await pause(1.0)
    goal_handle.succeed()
    return result


def main(args=None):
    global node
    rclpy.init(args=args)
    node = rclpy.create_node("plain_server")
    server = ActionServer(
        node, Countdown, "countdown", execute_callback=execute_callback, cancel_callback=cancel_callback
    )
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        server.destroy()
        node.destroy_node()


if __name__ == "__main__":
    main()
