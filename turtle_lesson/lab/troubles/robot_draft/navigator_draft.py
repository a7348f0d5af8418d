"""A first navigator in closed loop: a timer steers, the service's callback awaits the end of the drive."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.task import Future
from robot_controller.srv import NavigateTo
from turtlesim.msg import Pose

PATIENCE = 12.0


class Navigator(Node):
    """Offers /navigate_to. With the parameter `short_way` it turns the short way round."""

    def __init__(self) -> None:
        super().__init__("navigator")
        self.declare_parameter("short_way", False)
        self.pose = Pose()
        self.goal: NavigateTo.Request | None = None
        self.driven = 0.0
        self.done = Future()
        self.commands = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 1)
        self.create_service(NavigateTo, "/navigate_to", self.on_goal, callback_group=ReentrantCallbackGroup())
        self.create_timer(0.1, self.on_timer)

    def on_pose(self, pose: Pose) -> None:
        """Keep the newest pose."""
        self.pose = pose

    async def on_goal(self, request: NavigateTo.Request, response: NavigateTo.Response) -> NavigateTo.Response:
        """Drive there, and answer at the end."""
        self.goal, self.done, self.driven = request, Future(), 0.0
        response.success = await self.done
        response.time_taken = self.driven
        return response

    def on_timer(self) -> None:
        """Steer, if there is a goal."""
        if self.goal is not None:
            self.driven += 0.1
            self.steer(self.goal)

    def steer(self, goal: NavigateTo.Request) -> None:
        """Send the next command; stop at the goal or when patience is over."""
        dx, dy = goal.x - self.pose.x, goal.y - self.pose.y
        distance = math.hypot(dx, dy)
        if distance < 0.15 or self.driven > PATIENCE:
            self.commands.publish(Twist())
            self.goal = None
            self.done.set_result(distance < 0.2)
            return
        error = math.atan2(dy, dx) - self.pose.theta
        if self.get_parameter("short_way").value:
            error = math.remainder(error, math.tau)
        command = Twist()
        command.angular.z = max(-2.0, min(2.0, 3.0 * error))
        command.linear.x = min(2.0, 2.0 * distance) if abs(error) < 0.3 else 0.0
        self.commands.publish(command)


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
