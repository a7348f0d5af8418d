"""When the programs of a launch come up: one after the other, in every run at the same robot time."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from launch_world import write_launch_file

from turtle_lesson import Lesson, start
from turtle_lesson.ros.ament.package import Package
from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.launching.service import LaunchHandle, launch_file

UP = "import time\nprint(f'up at {time.time() - 1.8e9:.1f}')\n"
PROGRAMS = {
    "up": UP + "time.sleep(60)\n",
    "ends": UP,
    "controller": """\
import rclpy
from geometry_msgs.msg import Point
from rclpy.node import Node
from turtlesim.msg import Pose


class Controller(Node):
    def __init__(self):
        super().__init__('controller')
        self.pose = None
        self.create_subscription(Pose, '/turtle1/pose', self.on_pose, 10)
        self.create_subscription(Point, '/goal', self.on_goal, 10)
        self.create_timer(0.1, self.on_timer)

    def on_pose(self, pose):
        self.pose = pose

    def on_goal(self, goal):
        print(f'{goal.x - self.pose.x:.1f} m to go')

    def on_timer(self):
        self.pose.x


rclpy.init()
rclpy.spin(Controller())
""",
    "sender": """\
import rclpy
from geometry_msgs.msg import Point

rclpy.init()
node = rclpy.create_node('sender')
node.create_publisher(Point, '/goal', 10).publish(Point(x=8.0))
rclpy.spin(node)
""",
}


@pytest.fixture
def lesson(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Iterator[Lesson]:
    """A world without a simulator, and with these programs in the package `demo`."""
    lesson = start(simulator=False)
    files = {name: tmp_path / f"{name}.py" for name in PROGRAMS}
    for name, file in files.items():
        file.write_text(PROGRAMS[name])
    lesson._world.packages.add(Package("demo", tmp_path, executables=dict(files)))
    capsys.readouterr()
    yield lesson
    lesson._world.close()


def node(executable: str, package: str = "demo", **more: str) -> str:
    words = "".join(f", {name}={value}" for name, value in more.items())
    return f"Node(package='{package}', executable='{executable}', output='screen'{words}),\n"


def launch(lesson: Lesson, folder: Path, actions: str) -> LaunchHandle:
    return launch_file(lesson._world, write_launch_file(folder, actions))


def said(capsys: pytest.CaptureFixture[str]) -> list[str]:
    """What programs printed, with their names."""
    return re.findall(r"^\[(\S+-\d+\] [^\[\n].*)$", capsys.readouterr().out, re.MULTILINE)


def test_the_nodes_of_a_launch_come_up_one_after_the_other(capsys: pytest.CaptureFixture[str]) -> None:
    lesson = start()
    capsys.readouterr()
    handle = lesson.launch("robot_controller", "start_system.launch.py")
    lines = capsys.readouterr().out.splitlines()
    assert [line.partition(" with")[0] for line in lines[1:4]] == [
        "[INFO] [navigator-1]: process started",
        "[INFO] [status_monitor-2]: process started",
        "[INFO] [obstacle_detector-3]: process started",
    ]
    times = [re.findall(r"\[18000000(\d\d\.\d)\d+\] \[(\w+)\]", line) for line in lines[4:]]
    assert times == [[("00.3", "navigator")], [("00.6", "status_monitor")], [("00.9", "obstacle_detector")]]
    assert lesson.now == 0.9
    names = set(lesson._recording.node.get_node_names())
    assert {"navigator", "status_monitor", "obstacle_detector"} <= names
    assert len(handle._service.processes) == 3 and all(each.alive for each in handle._service.processes)


@pytest.mark.parametrize("seed", [0, 1, 17])
def test_no_chance_is_in_it(seed: int, capsys: pytest.CaptureFixture[str]) -> None:
    lesson = start(seed=seed)
    lesson.run(0.5)
    lesson.launch("robot_controller", "start_system.launch.py")
    assert lesson.now == 1.4
    assert "[1800000000.800000000] [navigator]" in capsys.readouterr().out


@pytest.mark.parametrize("first", ["turtlesim", "controller"])
def test_a_controller_meets_no_goal_and_no_timer_before_the_first_pose(
    lesson: Lesson, tmp_path: Path, capsys: pytest.CaptureFixture[str], first: str
) -> None:
    """It breaks without a pose. Turtlesim, which is no Python program, is up before it wherever it stands."""
    nodes = [node("turtlesim_node", "turtlesim"), node("controller")]
    handle = launch(lesson, tmp_path, "".join(nodes if first == "turtlesim" else nodes[::-1]) + node("sender"))
    lesson.run(2)
    assert said(capsys) == [f"controller-{1 if first == 'controller' else 2}] 2.5 m to go"]
    assert all(each.alive for each in handle._service.processes)


def test_small_commands_are_up_at_once_and_ros2_takes_its_turn(
    lesson: Lesson, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ask = "ExecuteProcess(cmd=['ros2', 'node', 'list'], output='screen'),\n"
    launch(lesson, tmp_path, node("sender") + ask + "ExecuteProcess(cmd=['echo', 'soon'], output='screen'),\n")
    lesson.run(0.1)
    assert said(capsys) == ["echo-3] soon"]
    lesson.run(2)
    assert "ros2-2] /sender" in said(capsys)


def test_what_an_event_or_a_timer_starts_comes_after_the_rest(
    lesson: Lesson, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    on_start = (
        f"RegisterEventHandler(OnProcessStart(on_start=[{node('up', name=repr('third'))}], target_action=first)),"
    )
    timed = f"TimerAction(period=0.5, actions=[{node('up', name=repr('fourth'))}]),"
    later = f"TimerAction(period=3.0, actions=[{node('up', name=repr('fifth'))}]),"
    text = write_launch_file(tmp_path, on_start + timed + later + "first," + node("up")).read_text()
    text = text.replace("    return", f"    first = {node('up').rstrip().removesuffix(',')}\n    return", 1)
    (tmp_path / "test.launch.py").write_text(text)
    handle = launch_file(lesson._world, tmp_path / "test.launch.py")
    handle.wait_until_up()
    assert lesson.now == 0.9
    lesson.run(0.1)  # they have looked at the clock, which takes a microsecond
    assert [line.partition(" ")[2] for line in said(capsys)] == ["up at 0.3", "up at 0.6", "up at 0.9"]
    lesson.run(5)
    assert [line.partition(" ")[2] for line in said(capsys)] == ["up at 1.2", "up at 3.3"]


def test_a_program_that_respawns_takes_its_time_again(
    lesson: Lesson, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    launch(lesson, tmp_path, node("ends", respawn="True", respawn_max_retries="2"))
    lesson.run(5)
    assert said(capsys) == ["ends-1] up at 0.3", "ends-1] up at 0.6", "ends-1] up at 0.9"]


def test_ctrl_c_ends_programs_that_are_still_coming_up(
    lesson: Lesson, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    handle = launch(lesson, tmp_path, node("up") * 3)
    lesson.run(0.4)
    assert handle.running and said(capsys) == ["up-1] up at 0.3"]
    handle.stop()
    assert not handle.running
    assert [each.process.exit_code for each in handle._service.processes] == [-2, -2, -2]
    lesson.run(2)
    assert not [line for line in said(capsys) if "up at" in line]


def test_ros2_launch_returns_when_all_are_up(
    lesson: Lesson, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_launch_file(tmp_path, node("sender", name="'one'") + node("sender", name="'two'"))
    run_line(lesson._world, f"ros2 launch {path}")
    assert lesson.now == 0.6
    assert {"one", "two"} <= set(lesson._recording.node.get_node_names())
    assert (
        capsys.readouterr().out.splitlines()[-1]
        == f"[1] ros2 launch {path} is still running. To stop it, as Ctrl-C would: kill -INT %1"
    )


def test_ros2_launch_for_some_seconds_lets_these_pass_and_no_more(lesson: Lesson, tmp_path: Path) -> None:
    path = write_launch_file(tmp_path, node("sender", name="'one'") + node("sender", name="'two'"))
    run_line(lesson._world, f"ros2 launch --for 0.5 {path}")
    assert lesson.now == 0.5
    names = lesson._recording.node.get_node_names()
    assert "one" in names and "two" not in names


def test_ros2_run_is_up_at_once(lesson: Lesson) -> None:
    run_line(lesson._world, "ros2 run demo sender")
    assert lesson.now == 0.0
    assert "sender" in lesson._recording.node.get_node_names()


def order_of_the_system(seed: int, start_order: str = "shuffled") -> list[str]:
    lesson = start(seed=seed, simulator=False, start_order=start_order)
    handle = lesson.launch("robot_controller", "start_system.launch.py")
    assert lesson.now == 0.9 and all(each.alive for each in handle._service.processes)
    return [each.name for each in handle._service.processes]


def test_the_seed_decides_about_a_shuffled_order_and_names_stay_as_written() -> None:
    written = ["navigator-1", "status_monitor-2", "obstacle_detector-3"]
    assert order_of_the_system(1, "as written") == written
    orders = [order_of_the_system(seed) for seed in range(8)]
    assert [order_of_the_system(seed) for seed in range(3)] == orders[:3]
    assert all(sorted(order) == sorted(written) for order in orders)
    assert len(set(map(tuple, orders))) > 3


def test_another_start_order_is_refused() -> None:
    with pytest.raises(ValueError, match=r'^start_order must be "as written" or "shuffled", got \'random\'$'):
        start(start_order="random")
