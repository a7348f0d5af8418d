"""A speed limiter, such as a robot has before its motors: it passes commands from /wanted_vel on to /turtle1/cmd_vel."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class SpeedLimiter(Node):
    """Passes a command on every `command_period` seconds, at most `max_speed` m/s ahead; a stop is passed on at once."""

    def __init__(self) -> None:
        super().__init__("speed_limiter")
        self.declare_parameter("max_speed", 4.0)
        self.declare_parameter("command_period", 0.1)
        self.passed = self.get_clock().now()
        self.commands = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_subscription(Twist, "/wanted_vel", self.on_wanted, 10)

    def on_wanted(self, wanted: Twist) -> None:
        """Pass a command on if it is a stop, or if the last one is old enough."""
        now = self.get_clock().now()
        age = (now - self.passed).nanoseconds / 1e9
        if wanted == Twist() or age >= self.get_parameter("command_period").value - 0.01:
            fastest = self.get_parameter("max_speed").value
            wanted.linear.x = max(-fastest, min(fastest, wanted.linear.x))
            self.commands.publish(wanted)
            self.passed = now


def main() -> None:
    """Run the node until it is interrupted."""
    rclpy.init()
    try:
        rclpy.spin(SpeedLimiter())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
