"""The node /turtlesim as ROS sees it, against what a real one printed, answered and published."""

import csv
import io
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from turtle_lesson.ros.runtime.world import World, open_world
from turtle_lesson.turtlesim.turtle import float32

# isort: split
# Importing turtle_lesson made these packages importable.
import rclpy
from geometry_msgs.msg import Twist, Vector3
from rcl_interfaces.srv import DescribeParameters, GetParameters, SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_srvs.srv import Empty
from turtlesim.msg import Color, Pose
from turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative

from turtle_lesson.turtlesim import node as turtlesim_node

DATA = Path(__file__).parents[1] / "data" / "turtlesim"
SECOND = 1_000_000_000
NAN = math.nan


class Bench:
    """A world in which the simulator runs, and a node beside it that commands, calls and listens."""

    def __init__(self) -> None:
        self.world: World = open_world(seed=0)
        self.console = io.StringIO()
        self.process = self.world.spawn(turtlesim_node.main, name="turtlesim_node", stderr=self.console)
        rclpy.init()
        self.node: Node = rclpy.create_node("bench")
        self.run(0.02)

    def run(self, seconds: float) -> None:
        """Let time pass, and take what has arrived meanwhile."""
        self.world.sim.run_until(self.world.now + round(seconds * SECOND))

    def listen(self, kind: type, topic: str) -> list[Any]:
        """Return a list into which every message of a topic goes, from now on."""
        messages: list[Any] = []

        def program() -> None:
            rclpy.init()
            node = rclpy.create_node("listener" + topic.replace("/", "_"))
            node.create_subscription(kind, topic, messages.append, 10)
            rclpy.spin(node)

        self.world.spawn(program, name="listener")
        self.run(0.0001)
        return messages

    def call(self, kind: Any, service: str, **fields: Any) -> Any:
        client = self.node.create_client(kind, service)
        assert client.wait_for_service(timeout_sec=1.0), f"no service {service}"
        response = client.call(kind.Request(**fields))
        self.node.destroy_client(client)
        return response

    def command(self, forward: float, sideways: float = 0.0, angular: float = 0.0) -> None:
        """Publish one velocity command to turtle1."""
        publisher = self.node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        linear = Vector3(x=forward, y=sideways)
        publisher.publish(Twist(linear=linear, angular=Vector3(z=angular)))
        self.run(0.0005)
        self.node.destroy_publisher(publisher)

    def log(self) -> list[str]:
        """The lines on the simulator's console, without their times."""
        return re.sub(r" \[\d+\.\d+\] \[turtlesim\]", "", self.console.getvalue()).splitlines()


@pytest.fixture
def bench() -> Iterator[Bench]:
    bench = Bench()
    yield bench
    bench.world.close()


STARTED = [
    "[INFO]: Starting turtlesim with node name /turtlesim",
    "[INFO]: Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]",
]


# ---------------------------------------------------------------- the recorded session


def test_a_recorded_session_of_calls_gets_the_same_answers_and_log_lines(bench: Bench) -> None:
    assert bench.call(Spawn, "/spawn", x=2.0, y=2.0, name="turtle2").name == "turtle2"
    assert bench.call(Spawn, "/spawn", x=2.0, y=2.0, name="turtle2").name == ""
    assert bench.call(Spawn, "/spawn", x=3.0, y=3.0).name == "turtle3"
    assert bench.call(Kill, "/kill", name="turtle2") == Kill.Response()
    assert bench.call(Kill, "/kill", name="turtle2") == Kill.Response()
    assert bench.call(SetPen, "/turtle1/set_pen", r=255, width=5) == SetPen.Response()
    assert bench.call(Empty, "/clear") == Empty.Response()
    assert bench.call(Empty, "/reset") == Empty.Response()
    assert bench.call(Spawn, "/spawn", x=50.0, y=50.0, name="far").name == "far"
    bench.run(0.1)
    assert bench.log() == [
        *STARTED,
        "[INFO]: Spawning turtle [turtle2] at x=[2.000000], y=[2.000000], theta=[0.000000]",
        "[ERROR]: A turtle named [turtle2] already exists",
        "[INFO]: Spawning turtle [turtle3] at x=[3.000000], y=[3.000000], theta=[0.000000]",
        "[ERROR]: Tried to kill turtle [turtle2], which does not exist",
        "[INFO]: Clearing turtlesim.",
        "[INFO]: Resetting turtlesim.",
        "[INFO]: Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]",
        "[INFO]: Spawning turtle [far] at x=[50.000000], y=[50.000000], theta=[0.000000]",
        "[WARN]: Oh no! I hit the wall! (Clamping from [x=50.000000, y=-38.911110])",
    ]


def test_the_graph_is_the_recorded_one(bench: Bench) -> None:
    node, name = bench.node, ("turtlesim", "/")
    publishers = dict(node.get_publisher_names_and_types_by_node(*name))
    subscribers = dict(node.get_subscriber_names_and_types_by_node(*name))
    services = dict(node.get_service_names_and_types_by_node(*name))
    assert subscribers == {
        "/parameter_events": ["rcl_interfaces/msg/ParameterEvent"],
        "/turtle1/cmd_vel": ["geometry_msgs/msg/Twist"],
    }
    assert publishers == {
        "/parameter_events": ["rcl_interfaces/msg/ParameterEvent"],
        "/rosout": ["rcl_interfaces/msg/Log"],
        "/turtle1/color_sensor": ["turtlesim/msg/Color"],
        "/turtle1/pose": ["turtlesim/msg/Pose"],
        "/turtle1/rotate_absolute/_action/feedback": ["turtlesim/action/RotateAbsolute_FeedbackMessage"],
        "/turtle1/rotate_absolute/_action/status": ["action_msgs/msg/GoalStatusArray"],
    }
    assert {service: types for service, types in services.items() if not service.startswith("/turtlesim/")} == {
        "/clear": ["std_srvs/srv/Empty"],
        "/kill": ["turtlesim/srv/Kill"],
        "/reset": ["std_srvs/srv/Empty"],
        "/spawn": ["turtlesim/srv/Spawn"],
        "/turtle1/rotate_absolute/_action/cancel_goal": ["action_msgs/srv/CancelGoal"],
        "/turtle1/rotate_absolute/_action/get_result": ["turtlesim/action/RotateAbsolute_GetResult"],
        "/turtle1/rotate_absolute/_action/send_goal": ["turtlesim/action/RotateAbsolute_SendGoal"],
        "/turtle1/set_pen": ["turtlesim/srv/SetPen"],
        "/turtle1/teleport_absolute": ["turtlesim/srv/TeleportAbsolute"],
        "/turtle1/teleport_relative": ["turtlesim/srv/TeleportRelative"],
    }
    (subscription,) = node.get_subscriptions_info_by_topic("/turtle1/cmd_vel")
    assert "depth=7" in repr(subscription.qos_profile)


# ---------------------------------------------------------------- poses


def recorded_phase(phase: str) -> list[tuple[str, ...]]:
    with open(DATA / "turtle_trace.csv", newline="", encoding="utf-8") as file:
        return [tuple(line[2:]) for line in csv.reader(file) if line[0] == phase]


def as_recorded(pose: Pose) -> tuple[str, ...]:
    numbers = (pose.x, pose.y, pose.theta, pose.linear_velocity, pose.angular_velocity)
    return tuple(f"{float32(number):.9g}" for number in numbers)


def test_a_pose_comes_every_16_ms(bench: Bench) -> None:
    poses = bench.listen(Pose, "/turtle1/pose")
    bench.run(2.0)
    assert len(poses) == 125


def test_a_single_command_moves_the_turtle_through_the_recorded_poses(bench: Bench) -> None:
    poses = bench.listen(Pose, "/turtle1/pose")
    bench.command(1.0)
    bench.run(1.5)
    recorded = recorded_phase("single publish 1 m/s")
    moved = next(index for index, pose in enumerate(poses) if pose.x > 5.55)
    assert [as_recorded(pose) for pose in poses[moved : moved + 80]] == recorded[:80]
    assert len({id(pose) for pose in poses}) == len(poses)


def test_commands_at_10_hz_move_the_turtle_through_the_recorded_arc(bench: Bench) -> None:
    recorded = recorded_phase("arc v=1 w=1 for 3 s at 10 Hz")
    poses = bench.listen(Pose, "/turtle1/pose")
    for _ in range(21):
        bench.command(1.0, 0.0, 1.0)
        bench.run(0.0995)
    bench.run(1.5)
    moved = next(index for index, pose in enumerate(poses) if pose.theta)
    assert [as_recorded(pose) for pose in poses[moved : moved + 200]] == recorded[:200]


def test_two_runs_publish_the_same_poses() -> None:
    runs = []
    for _ in range(2):
        bench = Bench()
        poses = bench.listen(Pose, "/turtle1/pose")
        bench.command(1.5, 0.5, -2.0)
        bench.run(3.0)
        runs.append([repr(pose) for pose in poses])
    assert runs[0] == runs[1]


def test_teleports_and_spawned_turtles_show_in_their_own_poses(bench: Bench) -> None:
    bench.call(Spawn, "/spawn", x=2.0, y=3.0, theta=1.0, name="second")
    first, second = bench.listen(Pose, "/turtle1/pose"), bench.listen(Pose, "/second/pose")
    bench.call(TeleportAbsolute, "/turtle1/teleport_absolute", x=1.0, y=1.0, theta=math.pi / 2)
    bench.call(TeleportRelative, "/turtle1/teleport_relative", linear=2.0, angular=0.0)
    bench.run(0.05)
    assert (first[-1].x, first[-1].y, first[-1].theta) == pytest.approx((1.0, 3.0, math.pi / 2), abs=1e-6)
    assert (second[-1].x, second[-1].y, second[-1].theta) == pytest.approx((2.0, 3.0, 1.0))


def test_a_killed_turtle_is_silent_and_gone_and_its_name_is_free(bench: Bench) -> None:
    poses = bench.listen(Pose, "/turtle1/pose")
    bench.run(0.1)
    bench.call(Kill, "/kill", name="turtle1")
    bench.run(0.01)
    before = len(poses)
    bench.run(0.5)
    assert before == len(poses)
    assert bench.node.count_subscribers("/turtle1/cmd_vel") == bench.node.count_services("/turtle1/set_pen") == 0
    assert bench.call(Spawn, "/spawn", x=1.0, y=1.0, name="turtle1").name == "turtle1"
    bench.run(0.5)
    assert poses[-1].x == 1.0


# ---------------------------------------------------------------- walls, refusals


def test_a_turtle_that_pushes_against_a_wall_is_reported_at_once_and_then_every_second(bench: Bench) -> None:
    bench.call(TeleportAbsolute, "/turtle1/teleport_absolute", x=11.0, y=5.5, theta=0.0)
    for _ in range(30):
        bench.command(1.0)
        bench.run(0.0995)
    warnings = [line for line in bench.log() if line.startswith("[WARN]")]
    assert len(warnings) == 3
    assert re.fullmatch(
        r"\[WARN\]: Oh no! I hit the wall! \(Clamping from \[x=11\.\d{6}, y=5\.58888\d\]\)", warnings[0]
    )


def test_every_new_bump_is_reported(bench: Bench) -> None:
    bench.call(TeleportAbsolute, "/turtle1/teleport_absolute", x=11.0, y=5.5, theta=0.0)
    for speed in (1.0, -1.0, 1.0, -1.0):
        bench.command(speed)
        bench.run(0.3)
    assert sum(line.startswith("[WARN]") for line in bench.log()) == 2


def test_a_name_that_would_end_the_real_program_is_refused_with_an_error(bench: Bench) -> None:
    assert bench.call(Spawn, "/spawn", x=3.0, y=3.0, name="bad name").name == ""
    assert bench.log()[-1].startswith("[ERROR]: A turtle cannot be named [bad name]")
    assert bench.process.alive


def test_numbers_that_are_none_are_refused_and_reported_once_a_second(bench: Bench) -> None:
    poses = bench.listen(Pose, "/turtle1/pose")
    for _ in range(20):
        bench.command(NAN)
        bench.run(0.0995)
    bench.command(0.0, math.inf)
    assert bench.call(Spawn, "/spawn", x=NAN, y=3.0).name == ""
    bench.call(TeleportAbsolute, "/turtle1/teleport_absolute", x=1.0, y=math.inf)
    bench.call(TeleportRelative, "/turtle1/teleport_relative", linear=NAN)
    bench.run(0.1)
    assert {(pose.x, pose.y, pose.theta) for pose in poses} == {(float32(5.544444561), float32(5.544444561), 0.0)}
    errors = [line for line in bench.log() if line.startswith("[ERROR]")]
    assert sum("ignores the velocity command linear.x=nan" in line for line in errors) == 2
    assert sum("finite" in line for line in errors) == len(errors)
    assert bench.process.alive


# ---------------------------------------------------------------- colours, parameters, the end


def colours(messages: list[Color]) -> list[tuple[int, int, int]]:
    return [(message.r, message.g, message.b) for message in messages]


def test_the_colour_sensor_sees_a_bare_canvas_then_the_turtles_own_trail(bench: Bench) -> None:
    messages = bench.listen(Color, "/turtle1/color_sensor")
    bench.run(0.1)
    assert set(colours(messages)) == {(255, 255, 255)}
    bench.command(1.0)
    bench.run(0.5)
    assert colours(messages)[-1] == (179, 184, 255)
    bench.call(SetPen, "/turtle1/set_pen", r=255, g=1, b=2, width=3)
    bench.run(0.3)
    assert colours(messages)[-1] == (255, 1, 2)
    bench.call(Empty, "/clear")
    bench.call(SetPen, "/turtle1/set_pen", off=1)
    bench.run(0.1)
    assert colours(messages)[-1] == (255, 255, 255)


def test_the_background_is_described_and_its_range_is_kept(bench: Bench) -> None:
    described = bench.call(DescribeParameters, "/turtlesim/describe_parameters", names=["background_b"])
    (descriptor,) = described.descriptors
    (bounds,) = descriptor.integer_range
    assert descriptor.description == "Blue channel of the background color"
    assert (bounds.from_value, bounds.to_value, bounds.step) == (0, 255, 1)

    names = ["background_r", "background_g", "background_b"]
    values = bench.call(GetParameters, "/turtlesim/get_parameters", names=names).values
    assert [value.integer_value for value in values] == [69, 86, 255]

    def set_red(value: object) -> Any:
        parameter = Parameter("background_r", value=value).to_parameter_msg()
        return bench.call(SetParameters, "/turtlesim/set_parameters", parameters=[parameter]).results[0]

    assert set_red(150).successful
    assert not set_red(300).successful


def test_the_program_ends_quietly_when_it_is_stopped(bench: Bench) -> None:
    bench.process.interrupt()
    bench.run(0.1)
    assert (bench.process.alive, bench.process.exit_code) == (False, 0)
    assert bench.log() == STARTED
    assert "turtlesim" not in bench.node.get_node_names()
