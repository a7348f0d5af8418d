"""Five small nodes, each of them a program of its own: a laser, an alarm, a speed limiter, and two monitors of the status."""

import math
from collections.abc import Callable

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from robot_controller.msg import TurtleStatus
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32, String
from turtlesim.msg import Pose

BEAMS = 181


class Laser(Node):
    """Publishes /obstacles five times a second, with best effort as most scanners do. A wall is half a metre ahead."""

    def __init__(self) -> None:
        super().__init__("laser")
        self.scans = self.create_publisher(LaserScan, "/obstacles", qos_profile_sensor_data)
        self.create_timer(0.2, self.on_timer)

    def on_timer(self) -> None:
        """Publish one scan."""
        scan = LaserScan(angle_min=-math.pi / 2, angle_max=math.pi / 2, angle_increment=math.pi / (BEAMS - 1))
        scan.range_max = 10.0
        scan.ranges = [0.5 if abs(beam - BEAMS // 2) < 5 else 10.0 for beam in range(BEAMS)]
        self.scans.publish(scan)


class ObstacleAlarm(Node):
    """Publishes on /alarm how near the nearest obstacle is, for each scan in which one is near.

    It hears /obstacles with the reliability that its parameter of this name says.
    """

    def __init__(self) -> None:
        super().__init__("obstacle_alarm")
        reliability = self.declare_parameter("reliability", "reliable").value
        quality = QoSProfile(depth=10, reliability=ReliabilityPolicy[reliability.upper()])
        self.alarm = self.create_publisher(Float32, "/alarm", 10)
        self.create_subscription(LaserScan, "/obstacles", self.on_scan, quality)

    def on_scan(self, scan: LaserScan) -> None:
        """Ring if something is nearer than a metre."""
        nearest = min(scan.ranges)
        if nearest < 1.0:
            self.alarm.publish(Float32(data=nearest))


class SpeedLimiter(Node):
    """Passes commands from /wanted_vel on to /turtle1/cmd_vel, as a robot may do before its motors.

    One every `command_period` seconds, at most `max_speed` m/s ahead; a stop is passed on at once.
    """

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


class StatusText(Node):
    """Reports the battery on /robot/status in words, ten times a second."""

    def __init__(self) -> None:
        super().__init__("status_monitor")
        self.status = self.create_publisher(String, "/robot/status", 10)
        self.create_timer(0.1, self.on_timer)

    def on_timer(self) -> None:
        """Publish the battery's charge."""
        self.status.publish(String(data="battery full"))


class StatusTwice(Node):
    """Keeps the newest pose and reports it on /robot/status, ten times a second."""

    def __init__(self) -> None:
        super().__init__("status_monitor")
        self.battery = 100.0
        self.pose = Pose()
        self.status = self.create_publisher(TurtleStatus, "/robot/status", 10)
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)
        self.create_timer(0.1, self.on_timer)
        self.start_reporting()

    def start_reporting(self) -> None:
        """Have the status published from now on."""
        self.create_timer(0.1, self.on_timer)

    def on_pose(self, pose: Pose) -> None:
        """Keep the newest pose."""
        self.pose = pose

    def on_timer(self) -> None:
        """Publish one status."""
        pose = self.pose
        self.status.publish(TurtleStatus(x=pose.x, y=pose.y, theta=pose.theta, battery=self.battery))
        self.battery = max(0.0, self.battery - 0.1)


def run(make_node: Callable[[], Node]) -> None:
    """Make a node, and spin it until it is interrupted."""
    rclpy.init()
    try:
        rclpy.spin(make_node())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
