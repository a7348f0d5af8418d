"""The finished nodes, as programs in a running world, seen through topics, services, parameters and logs."""

import io
import itertools
import math
import random
import re
from dataclasses import dataclass

import pytest

from turtle_lesson import start
from turtle_lesson.ros.runtime.world import current_world
from turtle_lesson.turtlesim.obstacles import Box, Circle

# isort: split
# Importing turtle_lesson made these packages importable.
import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from sensor_msgs.msg import LaserScan
from turtlesim.msg import Pose
from turtlesim.srv import TeleportAbsolute

WORLD = 11.088889
MIDDLE = WORLD / 2


class System:
    """A fresh world, the nodes that a test starts in it, and a node of the test's own that asks and hears."""

    def __init__(self, simulator=True, seed=0):
        self.lesson = start(seed=seed, simulator=simulator)
        self.logs = {}
        rclpy.init()
        self.me = rclpy.create_node("test")
        self.run(0.001)

    def node(self, name, **parameters):
        """Start a node of the package, as `ros2 run` with `-p name:=value` does. Returns its process."""
        target = current_world().packages.executable("robot_controller", name)
        given = [part for key, value in parameters.items() for part in ("-p", f"{key}:={value}")]
        self.logs[name] = io.StringIO()
        process = current_world().spawn(target, name=name, argv=[name, "--ros-args", *given], stderr=self.logs[name])
        self.lesson.run(0.001)
        return process

    def log(self, name):
        return self.logs[name].getvalue()

    def run(self, seconds):
        self.lesson.run(seconds)

    def listen(self, kind, topic):
        """Return a list that grows by (robot time, message) as messages arrive, in a process of its own."""
        heard = []

        def listener():
            rclpy.init()
            node = rclpy.create_node("listener")
            node.create_subscription(kind, topic, lambda m: heard.append((self.lesson.now, m)), 100)
            rclpy.spin(node)

        current_world().spawn(listener, name="listener")
        self.run(0.001)
        return heard

    def call(self, kind, service, **fields):
        """Send a request; returns its future at once."""
        client = self.me.create_client(kind, service)
        assert client.wait_for_service(5.0)
        return client.call_async(kind.Request(**fields))

    def answer(self, future, within=60.0):
        rclpy.spin_until_future_complete(self.me, future, timeout_sec=within)
        assert future.done(), f"no answer within {within} s"
        return future.result()

    def ask_for_goal(self, x, y, theta=0.0):
        from robot_controller.srv import NavigateTo

        return self.call(NavigateTo, "/navigate_to", x=x, y=y, theta=theta)

    def go(self, x, y, theta=0.0):
        return self.answer(self.ask_for_goal(x, y, theta))

    def get_parameter(self, node, name):
        values = self.answer(self.call(GetParameters, f"/{node}/get_parameters", names=[name])).values
        value = values[0]
        return {
            ParameterType.PARAMETER_INTEGER: value.integer_value,
            ParameterType.PARAMETER_DOUBLE: value.double_value,
            ParameterType.PARAMETER_STRING: value.string_value,
        }[value.type]

    def set_parameter(self, node, name, value):
        kind = {bool: "bool", int: "integer", float: "double", str: "string"}[type(value)]
        number = getattr(ParameterType, f"PARAMETER_{kind.upper()}")
        parameter = Parameter(name=name, value=ParameterValue(type=number, **{f"{kind}_value": value}))
        return self.answer(self.call(SetParameters, f"/{node}/set_parameters", parameters=[parameter])).results[0]

    def teleport(self, x, y, theta=0.0):
        self.answer(self.call(TeleportAbsolute, "/turtle1/teleport_absolute", x=x, y=y, theta=theta))

    def command(self, seconds, **speeds):
        """Command the turtle ten times a second for so long. Speeds: x, y (m/s), turn (rad/s)."""
        publisher = self.me.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        twist = Twist()
        twist.linear.x, twist.linear.y = speeds.get("x", 0.0), speeds.get("y", 0.0)
        twist.angular.z = speeds.get("turn", 0.0)
        for _ in range(round(seconds * 10)):
            publisher.publish(twist)
            self.run(0.1)


@pytest.fixture
def system():
    return System()


@pytest.fixture
def driven(system):
    """A system in which the navigator runs and has heard of the turtle."""
    system.node("navigator")
    system.run(0.1)
    return system


def error(pose, x, y, theta):
    return math.hypot(pose.x - x, pose.y - y), abs(math.remainder(pose.theta - theta, math.tau))


def gaps(heard):
    return [after[0] - before[0] for before, after in itertools.pairwise(heard)]


# -- the navigator -------------------------------------------------------------------------------------------

GOALS = [
    (5.0, 5.0, 0.0),
    (1.0, 5.0, math.pi),
    (1.0, 1.0, -math.pi / 2),
    (10.0, 1.0, 3.0),
    (10.0, 10.0, -3.0),
    (11.0, 0.0, 100.0),
    (0.0, WORLD, 1.0),
    (0.3, 10.9, 1.0),
]


def test_it_goes_from_goal_to_goal_and_ends_where_it_says(driven):
    poses = driven.listen(Pose, "/turtle1/pose")
    for goal in GOALS:
        answer = driven.go(*goal)
        distance, turn = error(poses[-1][1], *goal)
        assert answer.success and distance <= 0.05 and turn <= math.radians(4)
    assert driven.log("navigator").count("Goal reached") == len(GOALS)


@pytest.mark.parametrize("goal", GOALS)
def test_every_goal_from_the_middle_is_reached_within_the_launch_files_timeout(system, goal):
    system.node("navigator", goal_timeout=5.0)
    assert system.go(*goal).success


def test_the_time_taken_is_the_time_of_moving(driven):
    poses = driven.listen(Pose, "/turtle1/pose")
    for goal in GOALS[:5]:
        poses.clear()
        answer = driven.go(*goal)
        moving = [time for time, pose in poses if pose.linear_velocity or pose.angular_velocity]
        assert answer.time_taken == pytest.approx(moving[-1] - moving[0], abs=0.1)


def test_a_near_goal_is_answered_within_two_seconds(driven):
    asked = driven.lesson.now
    assert driven.go(6.0, 6.0, 0.8).success
    assert driven.lesson.now - asked < 2.0


def test_where_it_is_already_it_answers_without_moving(driven):
    poses = driven.listen(Pose, "/turtle1/pose")
    answer = driven.go(MIDDLE, MIDDLE, 0.0)
    assert answer.success and answer.time_taken == 0.0
    assert {(pose.x, pose.y, pose.theta) for _, pose in poses} == {(poses[0][1].x, poses[0][1].y, 0.0)}


def test_it_commands_ten_times_a_second_while_moving_and_zero_at_the_end_and_nothing_after(driven):
    commands = driven.listen(Twist, "/turtle1/cmd_vel")
    driven.run(2.0)
    assert commands == []
    driven.go(8.0, 8.0)
    driven.run(2.0)
    assert gaps(commands) == pytest.approx([0.1] * (len(commands) - 1), abs=1e-4)
    *moving, last = [(twist.linear.x, twist.angular.z) for _, twist in commands]
    assert last == (0.0, 0.0) and (0.0, 0.0) not in moving
    assert all(0.0 <= linear <= 4.0 and abs(angular) <= 6.0 for linear, angular in moving)


def test_when_the_time_is_over_it_stops_and_says_so(system):
    system.node("navigator", goal_timeout=1.0)
    poses = system.listen(Pose, "/turtle1/pose")
    answer = system.go(1.0, 1.0)
    assert not answer.success and answer.time_taken == pytest.approx(1.0, abs=0.1)
    assert "[WARN]" in system.log("navigator") and "goal_timeout gives (1.0 s)" in system.log("navigator")
    system.run(0.1)
    assert poses[-1][1].linear_velocity == poses[-1][1].angular_velocity == 0.0


@pytest.mark.parametrize(
    ("goal", "why"),
    [
        ((math.nan, 5.0), "x=nan"),
        ((5.0, math.inf), "y=inf"),
        ((5.0, 5.0, -math.inf), "theta=-inf"),
        ((12.0, 5.0), "(12.00, 5.00) is outside the world: x and y must be from 0 to 11.09"),
        ((5.0, -0.1), "outside the world"),
    ],
)
def test_what_is_no_goal_is_refused_at_once_with_the_reason_in_the_log(driven, goal, why):
    commands = driven.listen(Twist, "/turtle1/cmd_vel")
    asked = driven.lesson.now
    answer = driven.go(*goal)
    assert not answer.success and answer.time_taken == 0.0
    assert driven.lesson.now - asked < 0.01 and commands == []
    assert "Goal refused: " in driven.log("navigator") and why in driven.log("navigator")


def test_a_second_goal_is_refused_at_once_while_the_first_goes_on(driven):
    first = driven.ask_for_goal(9.0, 9.0)
    driven.run(1.0)
    asked = driven.lesson.now
    assert not driven.go(1.0, 1.0).success
    assert driven.lesson.now - asked < 0.01
    assert "Goal refused: still on the way to (9.00, 9.00)" in driven.log("navigator")
    assert driven.answer(first).success
    assert driven.go(1.0, 1.0).success


def test_without_a_simulator_it_gives_up_and_says_what_to_start():
    system = System(simulator=False)
    system.node("navigator")
    asked = system.lesson.now
    answer = system.go(5.0, 5.0)
    assert not answer.success and answer.time_taken == 0.0
    assert system.lesson.now - asked < 1.5
    assert "no pose heard on /turtle1/pose for 1 s. Is the simulator running?" in system.log("navigator")
    assert "ros2 run turtlesim turtlesim_node" in system.log("navigator")


def test_when_the_simulator_ends_on_the_way_the_goal_is_given_up():
    system = System(simulator=False)
    system.node("navigator")
    simulator = current_world().spawn(
        current_world().packages.executable("turtlesim", "turtlesim_node"), name="simulator"
    )
    system.run(0.5)
    commands = system.listen(Twist, "/turtle1/cmd_vel")
    goal = system.ask_for_goal(10.0, 10.0)
    system.run(0.5)
    simulator.interrupt()
    answer = system.answer(goal, within=2.0)
    assert not answer.success
    assert commands[-1][1] == Twist()


def test_interrupted_on_the_way_it_stops_the_turtle(system):
    navigator = system.node("navigator")
    poses = system.listen(Pose, "/turtle1/pose")
    system.ask_for_goal(10.0, 10.0)
    system.run(1.0)
    assert poses[-1][1].linear_velocity > 1.0
    navigator.interrupt()
    system.run(0.1)
    assert poses[-1][1].linear_velocity == poses[-1][1].angular_velocity == 0.0
    assert not navigator.alive and navigator.exit_code == 0


def test_interrupted_while_idle_it_leaves_the_turtle_to_others(system):
    navigator = system.node("navigator")
    commands = system.listen(Twist, "/turtle1/cmd_vel")
    system.run(1.0)
    navigator.interrupt()
    system.run(0.1)
    assert not navigator.alive and commands == []


def test_carried_off_on_the_way_it_still_gets_there(driven):
    goal = driven.ask_for_goal(9.0, 9.0)
    driven.run(1.0)
    driven.teleport(1.0, 1.0, 3.0)
    assert driven.answer(goal).success


def test_its_speeds_can_be_changed_on_the_way_and_values_out_of_range_are_refused(driven):
    poses = driven.listen(Pose, "/turtle1/pose")
    goal = driven.ask_for_goal(MIDDLE + 5.0, MIDDLE)
    driven.run(0.5)
    assert poses[-1][1].linear_velocity == pytest.approx(4.0)
    assert driven.set_parameter("navigator", "linear_speed", 0.5).successful
    driven.run(0.2)
    assert poses[-1][1].linear_velocity == pytest.approx(0.5)
    refused = driven.set_parameter("navigator", "linear_speed", 20.0)
    assert not refused.successful and "out of range" in refused.reason
    assert not driven.set_parameter("navigator", "linear_speed", 1).successful  # a whole number is no double
    assert driven.set_parameter("navigator", "goal_timeout", 60.0).successful
    assert driven.answer(goal).success


def scan(*ranges):
    return LaserScan(range_min=0.1, range_max=10.0, ranges=list(ranges))


def publish_scans(system, ranges, seconds):
    publisher = system.me.create_publisher(LaserScan, "/obstacles", 10)
    for _ in range(round(seconds * 5)):
        publisher.publish(scan(*ranges))
        system.run(0.2)


def test_driving_past_something_near_it_warns_every_two_seconds(system):
    system.node("navigator", linear_speed=0.5, goal_timeout=60.0)
    goal = system.ask_for_goal(MIDDLE + 5.0, MIDDLE)
    publish_scans(system, [5.0, 0.3, math.nan, 0.0], seconds=7.0)
    assert system.log("navigator").count("Obstacle 0.30 m away") == 4
    assert system.answer(goal).success


def test_standing_by_something_near_it_warns_once_until_it_was_away(driven):
    publish_scans(driven, [0.3], seconds=7.0)
    assert driven.log("navigator").count("Obstacle 0.30 m away") == 1
    publish_scans(driven, [3.0], seconds=1.0)
    publish_scans(driven, [0.3], seconds=1.0)
    assert driven.log("navigator").count("Obstacle 0.30 m away") == 2


def test_made_up_scans_do_not_make_it_warn_unless_it_is_told_to(driven):
    driven.node("obstacle_detector")
    driven.run(2.0)
    assert "Obstacle" not in driven.log("navigator")
    driven.set_parameter("navigator", "obstacle_warning_distance", 0.6)
    driven.run(2.0)
    assert "Obstacle 0.50 m away" in driven.log("navigator")


# -- the status monitor --------------------------------------------------------------------------------------


def statuses(system):
    from robot_controller.msg import TurtleStatus

    return system.listen(TurtleStatus, "/robot/status")


def test_it_reports_the_true_pose_ten_times_a_second(driven):
    driven.node("status_monitor")
    heard, poses = statuses(driven), driven.listen(Pose, "/turtle1/pose")
    driven.go(8.0, 3.0, 1.0)
    driven.run(0.3)
    assert gaps(heard) == pytest.approx([0.1] * (len(heard) - 1), abs=1e-4)
    last, pose = heard[-1][1], poses[-1][1]
    assert (last.x, last.y, last.theta) == (pose.x, pose.y, pose.theta)
    assert (last.vel_x, last.vel_y) == (0.0, 0.0)


@dataclass
class Motion:
    """Where the turtle starts, what it is told, and which way it then really goes."""

    place: tuple[float, float, float]
    told: dict[str, float]
    velocity: tuple[float, float]


SLANT = math.sqrt(0.5)


@pytest.mark.parametrize(
    "motion",
    [
        Motion((2.0, 2.0, 0.0), {"x": 1.0}, (1.0, 0.0)),
        Motion((5.0, 5.0, 0.0), {"x": -1.0}, (-1.0, 0.0)),
        Motion((5.0, 5.0, math.pi / 4), {"x": 2.0}, (2 * SLANT, 2 * SLANT)),
        Motion((5.0, 5.0, 0.0), {"y": 1.0}, (0.0, 1.0)),
        Motion((5.0, 5.0, math.pi / 2), {"x": 1.0, "y": 1.0}, (-1.0, 1.0)),
        Motion((5.0, 5.0, 0.0), {"turn": 1.0}, (0.0, 0.0)),
        Motion((WORLD, 5.0, 0.0), {"x": 1.0}, (0.0, 0.0)),  # against a wall
        Motion((WORLD, 5.0, math.pi / 4), {"x": 1.0}, (0.0, SLANT)),  # along a wall that it pushes against
    ],
    ids=["ahead", "back", "slant", "sideways", "both", "turning", "wall", "along a wall"],
)
def test_it_reports_the_velocity_as_it_is_in_the_world(system, motion):
    system.node("status_monitor")
    heard = statuses(system)
    system.teleport(*motion.place)
    system.command(1.0, **motion.told)
    last = heard[-1][1]
    assert (last.vel_x, last.vel_y) == pytest.approx(motion.velocity, abs=1e-3)


def test_a_teleport_is_no_velocity(system):
    system.node("status_monitor", publish_rate=100)
    heard = statuses(system)
    system.teleport(1.0, 1.0)
    system.run(0.5)
    assert all((status.vel_x, status.vel_y) == (0.0, 0.0) for _, status in heard)
    assert heard[-1][1].x == pytest.approx(1.0)


def test_the_battery_falls_by_a_tenth_a_message_down_to_zero(system):
    heard = statuses(system)
    system.node("status_monitor", publish_rate=100)
    system.run(11.0)
    charge = [status.battery for _, status in heard]
    assert charge[:3] == pytest.approx([100.0, 99.9, 99.8])
    assert charge[999:] == pytest.approx([0.1, *[0.0] * (len(charge) - 1000)]) and len(charge) > 1050


def test_its_rate_can_be_given_and_changed(system):
    system.node("status_monitor", publish_rate=20)
    heard = statuses(system)
    system.run(1.0)
    assert gaps(heard) == pytest.approx([0.05] * (len(heard) - 1), abs=1e-4)
    assert system.set_parameter("status_monitor", "publish_rate", 4).successful
    system.run(0.2)
    heard.clear()
    system.run(2.0)
    assert gaps(heard) == pytest.approx([0.25] * (len(heard) - 1), abs=1e-4)
    refused = system.set_parameter("status_monitor", "publish_rate", 0)
    assert not refused.successful and "out of range" in refused.reason


def test_without_a_simulator_it_reports_zeros_and_warns_every_five_seconds():
    system = System(simulator=False)
    heard = statuses(system)
    system.node("status_monitor")
    system.run(12.05)
    assert len(heard) == 120
    assert all((s.x, s.y, s.theta, s.vel_x, s.vel_y) == (0.0, 0.0, 0.0, 0.0, 0.0) for _, s in heard)
    assert system.log("status_monitor").count("No pose heard on /turtle1/pose") == 3


def test_with_a_simulator_it_does_not_warn(system):
    system.node("status_monitor")
    system.run(10.0)
    assert "WARN" not in system.log("status_monitor")


# -- the obstacle detector -----------------------------------------------------------------------------------


def scans(system):
    return system.listen(LaserScan, "/obstacles")


def test_a_scan_has_181_readings_that_agree_with_its_angles(system):
    system.node("obstacle_detector")
    heard = scans(system)
    system.run(1.0)
    assert gaps(heard) == pytest.approx([0.2] * (len(heard) - 1), abs=1e-4)
    time, last = heard[-1]
    assert last.header.frame_id == "base_link"
    stamp = last.header.stamp.sec + last.header.stamp.nanosec / 1e9
    assert stamp == pytest.approx(1_800_000_000 + time, abs=0.001)
    assert (last.angle_min, last.angle_max) == pytest.approx((-math.pi / 2, math.pi / 2))
    assert len(last.ranges) == 181
    assert last.angle_min + 180 * last.angle_increment == pytest.approx(last.angle_max, abs=1e-5)
    assert (last.range_min, last.range_max) == (0.0, 10.0)
    assert last.scan_time == pytest.approx(0.2) and last.time_increment == 0.0


def made_up(seed, seconds=40.0):
    system = System()
    system.node("obstacle_detector", seed=seed)
    heard = scans(system)
    system.run(seconds)
    return [reading for _, each in heard for reading in each.ranges]


def test_made_up_readings_show_half_a_metre_in_one_beam_of_twenty():
    readings = made_up(seed=0)
    assert set(readings) == {0.5, 10.0}
    assert readings.count(0.5) / len(readings) == pytest.approx(0.05, abs=0.005)


def test_made_up_readings_follow_from_their_seed():
    assert made_up(seed=3, seconds=2.0) == made_up(seed=3, seconds=2.0) != made_up(seed=4, seconds=2.0)


@pytest.mark.parametrize("seed", [0, 3, 2**31, 2**40 + 7, -5])
def test_made_up_readings_are_those_of_pythons_random_numbers(seed):
    chance = random.Random(seed).random
    readings = made_up(seed=seed, seconds=2.0)
    assert readings == [0.5 if chance() < 0.05 else 10.0 for _ in readings]


def test_without_a_seed_of_their_own_made_up_readings_follow_from_the_worlds():
    def readings(world_seed):
        system = System(seed=world_seed)
        system.node("obstacle_detector")
        heard = scans(system)
        system.run(2.0)
        return [reading for _, each in heard for reading in each.ranges]

    assert readings(0) == readings(0) != readings(1)


def test_from_the_world_it_sees_obstacles_and_walls_from_where_the_turtle_is(system):
    system.lesson.place(Circle(x=MIDDLE + 3.0, y=MIDDLE, radius=0.5), Box(MIDDLE, MIDDLE - 2.0, 1.0, 1.0))
    system.node("obstacle_detector", source="world")
    heard = scans(system)
    system.run(1.0)
    ranges = heard[-1][1].ranges
    assert [ranges[0], ranges[90], ranges[180]] == pytest.approx([1.5, 2.5, MIDDLE], abs=1e-4)
    system.teleport(MIDDLE, MIDDLE, math.pi)
    system.run(0.5)
    ranges = heard[-1][1].ranges
    assert [ranges[0], ranges[90], ranges[180]] == pytest.approx([MIDDLE, MIDDLE, 1.5], abs=1e-4)


def test_from_the_world_it_follows_changes_of_the_obstacles(system):
    system.node("obstacle_detector", source="world")
    heard = scans(system)
    system.run(0.5)
    assert heard[-1][1].ranges[90] == pytest.approx(MIDDLE, abs=1e-4)
    system.lesson.place(Circle(x=MIDDLE + 3.0, y=MIDDLE, radius=0.5))
    system.run(0.5)
    assert heard[-1][1].ranges[90] == pytest.approx(2.5, abs=1e-4)
    system.lesson.set_obstacles([])
    system.run(0.5)
    assert heard[-1][1].ranges[90] == pytest.approx(MIDDLE, abs=1e-4)


def test_from_the_world_without_a_simulator_there_is_no_scan_but_a_warning():
    system = System(simulator=False)
    system.node("obstacle_detector", source="world")
    heard = scans(system)
    system.run(12.0)
    assert heard == []
    assert system.log("obstacle_detector").count("No scan: no pose heard on /turtle1/pose") == 3


def test_its_source_can_be_changed_while_it_runs(system):
    system.lesson.place(Circle(x=MIDDLE + 3.0, y=MIDDLE, radius=0.5))
    system.node("obstacle_detector")
    heard = scans(system)
    system.run(1.0)
    assert set(heard[-1][1].ranges) == {0.5, 10.0}
    assert system.set_parameter("obstacle_detector", "source", "world").successful
    system.run(1.0)
    assert heard[-1][1].ranges[90] == pytest.approx(2.5, abs=1e-4)
    assert "WARN" not in system.log("obstacle_detector")
    assert system.set_parameter("obstacle_detector", "source", "mock").successful
    system.run(1.0)
    assert set(heard[-1][1].ranges) == {0.5, 10.0}


def test_a_source_that_does_not_exist_is_refused_with_the_two_that_do(system):
    system.node("obstacle_detector")
    refused = system.set_parameter("obstacle_detector", "source", "wrold")
    assert not refused.successful and refused.reason == "source must be 'mock' or 'world', not 'wrold'"
    process = system.node("obstacle_detector", source="lidar")
    assert not process.alive and process.exit_code == 1
    assert "source must be 'mock' or 'world', not 'lidar'" in system.log("obstacle_detector")


def test_its_rate_can_be_changed_while_it_runs(system):
    system.node("obstacle_detector")
    heard = scans(system)
    assert system.set_parameter("obstacle_detector", "scan_rate", 20).successful
    system.run(0.3)
    heard.clear()
    system.run(1.0)
    assert gaps(heard) == pytest.approx([0.05] * (len(heard) - 1), abs=1e-4)
    assert heard[-1][1].scan_time == pytest.approx(0.05)


# -- all three -----------------------------------------------------------------------------------------------


def test_the_launch_file_starts_the_three_with_their_parameters(system, capsys):
    system.lesson.launch("robot_controller", "start_system.launch.py")
    system.run(0.5)
    started = re.findall(r"\[(\w+)-\d\]: process started", capsys.readouterr().out)
    assert started == ["navigator", "status_monitor", "obstacle_detector"]
    assert system.get_parameter("navigator", "goal_timeout") == 5.0
    assert system.get_parameter("status_monitor", "publish_rate") == 10
    assert system.get_parameter("obstacle_detector", "scan_rate") == 5
    assert system.get_parameter("obstacle_detector", "source") == "mock"


def test_the_launch_files_arguments_reach_the_nodes(system):
    system.lesson.launch(
        "robot_controller",
        "start_system.launch.py",
        goal_timeout=8,
        publish_rate=20,
        scan_rate=2,
        source="world",
    )
    system.run(0.5)
    assert system.get_parameter("navigator", "goal_timeout") == 8.0
    assert system.get_parameter("status_monitor", "publish_rate") == 20
    assert system.get_parameter("obstacle_detector", "scan_rate") == 2
    assert system.get_parameter("obstacle_detector", "source") == "world"


def test_ctrl_c_on_the_launch_stops_the_turtle_and_ends_all_three(system, capsys):
    handle = system.lesson.launch("robot_controller", "start_system.launch.py")
    poses = system.listen(Pose, "/turtle1/pose")
    system.ask_for_goal(10.0, 10.0)
    system.run(1.0)
    handle.stop()
    system.run(0.5)
    assert poses[-1][1].linear_velocity == poses[-1][1].angular_velocity == 0.0
    assert capsys.readouterr().out.count("process has finished cleanly") == 3


@pytest.mark.parametrize("name", ["navigator", "status_monitor", "obstacle_detector"])
def test_ctrl_c_ends_each_without_a_traceback(system, name):
    process = system.node(name)
    system.run(1.0)
    process.interrupt()
    system.run(0.1)
    assert not process.alive and process.exit_code == 0
    assert "Traceback" not in system.log(name)


def test_two_minutes_with_a_goal_after_another(system):
    system.lesson.set_obstacles("three pillars")
    system.node("navigator")
    system.node("status_monitor")
    system.node("obstacle_detector", source="world")
    heard = statuses(system)
    goals = itertools.cycle(GOALS)
    while system.lesson.now < 120.0:
        assert system.go(*next(goals)).success
    assert gaps(heard) == pytest.approx([0.1] * (len(heard) - 1), abs=0.01)
    assert len(heard) >= 1190
    assert "ERROR" not in "".join(map(system.log, system.logs))
