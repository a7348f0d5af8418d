"""`ExecuteProcess` of what is no node: `ros2` commands, Python files and small commands, in robot time."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from launch_world import write, write_launch_file

from turtle_lesson.ros.ament.package import Package
from turtle_lesson.ros.launching.errors import LaunchError
from turtle_lesson.ros.launching.service import LaunchHandle, launch_file
from turtle_lesson.ros.runtime.world import World, open_world

SECOND = 1_000_000_000
LISTENER = """\
import rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node('listener')
node.declare_parameter('word', 'none')
node.create_subscription(String, 'chatter', lambda msg: print('heard', msg.data), 10)
rclpy.spin(node)
"""
SCRIPT = "import sys\nprint('script', sys.argv[1:])\nsys.exit(4)\n"

Launch = Callable[[str], LaunchHandle]


@pytest.fixture
def world(tmp_path: Path) -> Iterator[World]:
    world = open_world()
    world.packages.add(Package("demo", tmp_path, executables={"listener": write(tmp_path, LISTENER, "listener.py")}))
    yield world
    open_world()


@pytest.fixture
def begin(world: World, tmp_path: Path) -> Launch:
    return lambda actions: launch_file(world, write_launch_file(tmp_path, actions))


def run(world: World, seconds: float) -> None:
    world.sim.run_until(world.now + round(seconds * SECOND))


def console(capsys: pytest.CaptureFixture[str], folder: Path) -> list[str]:
    """What was printed, without launch's first line and the starts of processes."""
    text = re.sub(r" \[pid \d+", " [pid N", capsys.readouterr().out.replace(f"{folder}/", ""))
    return [line for line in text.splitlines() if "Default logging" not in line and "process started" not in line]


def test_a_command_that_ends(world: World, begin: Launch, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    handle = begin(
        "Node(package='demo', executable='listener', output='screen'),\n"
        "ExecuteProcess(cmd=['ros2', 'param', 'set', '/listener', 'word', 'hello'], output='screen', name='setter'),"
    )
    run(world, 1)
    assert console(capsys, tmp_path) == [
        "[setter-2] Set parameter successful",
        "[INFO] [setter-2]: process has finished cleanly [pid N]",
    ]
    assert [each.name for each in handle._service.processes] == ["listener-1", "setter-2"]


def test_a_command_without_end_goes_on_until_the_launch_ends(
    world: World, begin: Launch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    handle = begin(
        "Node(package='demo', executable='listener', output='screen'),\n"
        "ExecuteProcess(cmd=['ros2', 'topic', 'pub', '-r', '0.1', 'chatter', 'std_msgs/msg/String', '{data: hi}']),"
    )
    run(world, 31)
    assert console(capsys, tmp_path).count("[listener-1] heard hi") in (3, 4)
    assert handle.running
    handle.stop()
    assert console(capsys, tmp_path)[-1].startswith("[ERROR] [ros2-2]: process has died [pid N, exit code 2, cmd 'ros2")


@pytest.mark.parametrize(
    "action",
    [
        "ExecuteProcess(cmd=['python3', [ThisLaunchFileDir(), '/script.py'], 'a', 'b c'], output='screen')",
        "ExecuteProcess(cmd=[[ThisLaunchFileDir(), '/script.py'], 'a', 'b c'], output='screen')",
        "ExecuteProcess(cmd=['python3', [ThisLaunchFileDir(), '/script.py'], 'a', '\"b c\"'], shell=True, output='screen')",
        "ExecuteProcess(cmd=[['python3 ', ThisLaunchFileDir(), '/script.py a \"b c\"']], shell=True, output='screen')",
        "ExecuteProcess(cmd=['bash', '-c', ['python3 ', ThisLaunchFileDir(), '/script.py a \"b c\"']], output='screen')",
    ],
)
def test_a_python_file(
    world: World, begin: Launch, tmp_path: Path, capsys: pytest.CaptureFixture[str], action: str
) -> None:
    write(tmp_path, SCRIPT, "script.py")
    begin(f"{action},")
    run(world, 1)
    out, end = console(capsys, tmp_path)
    assert out.endswith("] script ['a', 'b c']")
    assert "exit code 4" in end


def test_small_commands_one_after_the_other_take_robot_time(
    world: World, begin: Launch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    begin(
        "ExecuteProcess(cmd=['bash', '-c', 'echo out line; false || echo other; sleep 0.5; exit 3'], output='screen'),\n"
        "ExecuteProcess(cmd=['true && echo yes && false && echo no'], shell=True, output='screen', name='both'),"
    )
    run(world, 0.4)
    assert console(capsys, tmp_path) == [
        "[bash-1] out line",
        "[bash-1] other",
        "[both-2] yes",
        "[ERROR] [both-2]: process has died [pid N, exit code 1, cmd 'true && echo yes && false && echo no'].",
    ]
    run(world, 0.2)
    assert console(capsys, tmp_path) == [
        "[ERROR] [bash-1]: process has died [pid N, exit code 3, cmd 'bash -c echo out line; false || echo other; "
        "sleep 0.5; exit 3'].",
    ]


def test_ctrl_c_ends_a_small_command_without_a_word(
    world: World, begin: Launch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    handle = begin("ExecuteProcess(cmd=['sleep', '100'], output='screen'),")
    run(world, 1)
    handle.stop()
    assert console(capsys, tmp_path) == [
        "[WARNING] [launch]: user interrupted with ctrl-c (SIGINT)",
        "[ERROR] [sleep-1]: process has died [pid N, exit code -2, cmd 'sleep 100'].",
    ]


def test_sleep_needs_a_number_of_seconds(
    begin: Launch, world: World, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    begin("ExecuteProcess(cmd=['sleep', 'inf'], output='screen'),")
    run(world, 1)
    assert console(capsys, tmp_path)[0] == "[sleep-1] sleep: invalid time interval 'inf'"


def test_ros2_run_is_the_program_itself(
    world: World, begin: Launch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    begin("ExecuteProcess(cmd=['ros2', 'run', 'demo', 'listener', '--ros-args', '-r', '__node:=bob']),")
    run(world, 0.5)
    assert [node.full_name for node in world.graph.nodes] == ["/bob"]


def test_a_program_of_a_package_by_its_path(
    world: World, begin: Launch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    begin(
        "ExecuteProcess(cmd=[ExecutableInPackage(executable='listener', package='demo'), "
        "'--ros-args', '-r', '__node:=ann']),"
    )
    run(world, 0.5)
    assert [node.full_name for node in world.graph.nodes] == ["/ann"]
    path = tmp_path / "lib" / "demo" / "listener"
    assert world.packages.program_at(path.as_posix()) == ("demo", "listener")
    others = [path.with_name("talker"), path.parent.with_name("other") / "listener", tmp_path / "demo" / "listener"]
    assert [world.packages.program_at(each.as_posix()) for each in others] == [None, None, None]


def test_a_wrong_command_says_so_where_it_prints(
    world: World, begin: Launch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    begin("ExecuteProcess(cmd=['ros2', 'topc', 'list'], output='screen'),")
    run(world, 0.5)
    lines = console(capsys, tmp_path)
    assert any("invalid choice: 'topc'" in line for line in lines)
    assert lines[-1] == "[ERROR] [ros2-1]: process has died [pid N, exit code 2, cmd 'ros2 topc list']."


@pytest.mark.parametrize(
    ("cmd", "reason", "hint"),
    [
        (
            "['ros2 topic list']",
            "ExecuteProcess(cmd='ros2 topic list'): there is no program called",
            "cmd is a list",
        ),
        ("['python3', 'nope.py']", "ExecuteProcess(cmd='python3 nope.py'): there is no file nope.py", ""),
        ("['bash', '-c', 'echo \"a']", "syntax error in the command 'echo \"a'", ""),
        ("['bash', '-c', '']", "there is no command in cmd=[…]", ""),
        ("['ros2', 'run', 'demo', 'listner']", "No executable found", "Did you mean 'listener'?"),
        ("['ros2', 'run', 'demmo', 'x']", "\"package 'demmo' not found", "Did you mean 'demo'?"),
        ("[]", "ExecuteProcess expected a command in 'cmd', got none", "cmd=['ros2', 'topic', 'list']"),
        ("'ros2 topic list'", "expected a list for 'cmd', got 'ros2 topic list'", "shell=True"),
    ],
)
def test_what_cannot_be_run_is_refused_with_advice(begin: Launch, cmd: str, reason: str, hint: str) -> None:
    with pytest.raises(LaunchError) as caught:
        begin(f"ExecuteProcess(cmd={cmd}),")
    assert reason in caught.value.reason and hint in caught.value.hint


def test_a_launch_by_hand_in_a_cell(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    from launch import LaunchDescription, LaunchService
    from launch.actions import ExecuteProcess, LogInfo, Shutdown, TimerAction
    from launch.substitutions import LaunchConfiguration

    service = LaunchService(argv=["a"])
    assert service.context.argv == ["a"]
    service.include_launch_description(
        LaunchDescription(
            [ExecuteProcess(cmd=["sleep", "100"]), TimerAction(period=0.1, actions=[Shutdown(reason="enough")])]
        )
    )
    assert service.run() == 0
    assert "process has died" in capsys.readouterr().out
    assert 0.1 <= world.now / SECOND < 1
    failing = LaunchService()
    failing.include_launch_description(LaunchDescription([LogInfo(msg=LaunchConfiguration("nope"))]))
    assert failing.run() == 1
    assert "launch configuration 'nope' does not exist" in capsys.readouterr().out


def test_a_launch_by_hand_goes_on_with_what_the_end_of_a_program_starts(
    world: World, capsys: pytest.CaptureFixture[str]
) -> None:
    from launch import LaunchDescription, LaunchService
    from launch.actions import ExecuteProcess

    after = ExecuteProcess(cmd=["echo", "after"], output="screen")
    service = LaunchService()
    service.include_launch_description(LaunchDescription([ExecuteProcess(cmd=["sleep", "1"], on_exit=[after])]))
    assert service.run() == 0
    assert "[echo-2] after" in capsys.readouterr().out.splitlines()
