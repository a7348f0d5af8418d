"""A navigator that first waits until the battery has been seen, in the callback of a timer."""

import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from robot_controller.msg import TurtleStatus
from robot_controller.srv import NavigateTo


class Navigator(Node):
    """Offers /navigate_to."""

    def __init__(self) -> None:
        super().__init__("navigator")
        self.battery = None
        self.create_subscription(TurtleStatus, "/robot/status", self.on_status, 10)
        self.create_service(NavigateTo, "/navigate_to", self.on_goal)
        self.timer = self.create_timer(0.01, self.on_start)

    def on_start(self) -> None:
        """Wait for the battery, once."""
        self.timer.cancel()
        while self.battery is None:
            time.sleep(0.1)

    def on_status(self, status: TurtleStatus) -> None:
        """Keep the battery's charge."""
        self.battery = status.battery

    def on_goal(self, request: NavigateTo.Request, response: NavigateTo.Response) -> NavigateTo.Response:
        """Drive there: still to be written."""
        return response


def main() -> None:
    """Run the node until it is interrupted."""
    rclpy.init()
    try:
        rclpy.spin(Navigator())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
