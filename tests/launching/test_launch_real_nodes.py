"""Launching nodes that really run: the recorded consoles of failing and working nodes, in robot time."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from launch_world import write

from turtle_lesson.ros.ament.package import Package
from turtle_lesson.ros.launching.service import LaunchHandle, launch_file
from turtle_lesson.ros.runtime.world import World, open_world

SECOND = 1_000_000_000

TALKER = """\
import rclpy
from rclpy.node import Node

class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.declare_parameter('period', 0.5)
        self.declare_parameter('word', 'hello')
        self.create_timer(self.get_parameter('period').value, self.tick)
        self.get_logger().info('started')

    def tick(self):
        print(self.get_parameter('word').value)

def main():
    rclpy.init()
    rclpy.spin(Talker())

if __name__ == '__main__':
    main()
"""
RAISES_IN_INIT = """\
import rclpy
from rclpy.node import Node

class Bad(Node):
    def __init__(self):
        super().__init__('bad_init')
        self.pub = self.create_publisher(Strng, 'x', 10)

def main():
    rclpy.init()
    node = Bad()

if __name__ == '__main__':
    main()
"""
RAISES_IN_CALLBACK = """\
import rclpy
from rclpy.node import Node

class Bad(Node):
    def __init__(self):
        super().__init__('bad_cb')
        self.create_timer(0.5, self.tick)

    def tick(self):
        raise ValueError('boom in callback')

def main():
    rclpy.init()
    rclpy.spin(Bad())

if __name__ == '__main__':
    main()
"""
ENDS = "import sys\nprint('done', file=sys.stderr)\nprint('no end', end='')\n"
SURROUNDINGS = """\
import os
import rclpy
rclpy.init()
node = rclpy.create_node('surroundings')
node.get_logger().info(f"sees {os.environ['COLOUR']} {os.getenv('SHAPE')}")
rclpy.spin(node)
"""
STUBBORN = """\
import time
while True:
    try:
        time.sleep(1)
    except KeyboardInterrupt:
        print('no')
"""
HEAD = """\
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
"""


@pytest.fixture
def world(tmp_path: Path) -> Iterator[World]:
    world = open_world()
    programs = {"talker": TALKER, "raise_init": RAISES_IN_INIT, "raise_cb": RAISES_IN_CALLBACK}
    programs |= {"ends": ENDS, "stubborn": STUBBORN, "surroundings": SURROUNDINGS}
    files = {name: write(tmp_path, text, f"{name}.py") for name, text in programs.items()}
    world.packages.add(Package("demo", tmp_path, executables=dict(files)))
    yield world
    open_world()


def start(world: World, folder: Path, actions: str, head: str = HEAD) -> LaunchHandle:
    return launch_file(world, write(folder, f"{head}{actions}    ])\n"))


def run(world: World, seconds: float) -> None:
    world.sim.run_until(world.now + round(seconds * SECOND))


def node(executable: str, **more: str) -> str:
    words = "".join(f", {name}={value}" for name, value in more.items())
    return f"        Node(package='demo', executable='{executable}'{words}),\n"


def console(capsys: pytest.CaptureFixture[str], folder: Path) -> list[str]:
    """What was printed since the last time, without launch's first line, log times and the test's folder."""
    text = re.sub(r"\[18\d{8}\.\d{9}\]", "[time]", capsys.readouterr().out.replace(f"{folder}/", ""))
    return [line for line in text.splitlines() if "Default logging" not in line]


def test_a_node_gets_its_parameters_and_its_lines_get_its_name(
    world: World, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    parameters = "[{'period': 1.0, 'word': 'it is: 5'}]"
    actions = node("talker", name="'bob'", output="'screen'", parameters=parameters)
    handle = start(world, tmp_path, actions)
    run(world, 2.5)
    assert console(capsys, tmp_path) == [
        "[INFO] [talker-1]: process started with pid [1002]",
        "[talker-1] [INFO] [time] [bob]: started",
        "[talker-1] it is: 5",
        "[talker-1] it is: 5",
    ]
    handle.stop()
    assert console(capsys, tmp_path) == [
        "[WARNING] [launch]: user interrupted with ctrl-c (SIGINT)",
        "[talker-1] Traceback (most recent call last):",
        '[talker-1]   File "talker.py", line 20, in <module>',
        "[talker-1]     main()",
        '[talker-1]   File "talker.py", line 17, in main',
        "[talker-1]     rclpy.spin(Talker())",
        "[talker-1] KeyboardInterrupt",
        "[ERROR] [talker-1]: process has died [pid 1002, exit code -2, cmd 'lib/demo/talker --ros-args "
        "-r __node:=bob -p period:=1.0 -p \"word:='it is: 5'\"'].".replace("\"word:='it is: 5'\"", "word:='it is: 5'"),
    ]
    assert [each.process.exit_code for each in handle._service.processes] == [-2]
    run(world, 10)
    assert console(capsys, tmp_path) == []


def test_failing_nodes_die_and_the_others_go_on(
    world: World, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    actions = node("raise_cb", name="'bad_cb'") + node("raise_init", name="'bad_init'") + node("talker")
    handle = start(world, tmp_path, actions)
    run(world, 2)
    lines = console(capsys, tmp_path)
    assert lines[:3] == [
        "[INFO] [raise_cb-1]: process started with pid [1002]",
        "[INFO] [raise_init-2]: process started with pid [1003]",
        "[INFO] [talker-3]: process started with pid [1004]",
    ]
    assert [line for line in lines if "raise_init-2" in line][1:] == [
        "[raise_init-2] Traceback (most recent call last):",
        '[raise_init-2]   File "raise_init.py", line 14, in <module>',
        "[raise_init-2]     main()",
        '[raise_init-2]   File "raise_init.py", line 11, in main',
        "[raise_init-2]     node = Bad()",
        '[raise_init-2]   File "raise_init.py", line 7, in __init__',
        "[raise_init-2]     self.pub = self.create_publisher(Strng, 'x', 10)",
        "[raise_init-2] NameError: name 'Strng' is not defined",
        "[ERROR] [raise_init-2]: process has died [pid 1003, exit code 1, cmd 'lib/demo/raise_init "
        "--ros-args -r __node:=bad_init'].",
    ]
    assert [line for line in lines if "raise_cb-1" in line][-2:] == [
        "[raise_cb-1] ValueError: boom in callback",
        "[ERROR] [raise_cb-1]: process has died [pid 1002, exit code 1, cmd 'lib/demo/raise_cb --ros-args "
        "-r __node:=bad_cb'].",
    ]
    assert repr(handle) == "<Launch of test.launch.py, running: talker-3>"


def test_a_program_that_ends_by_itself_has_finished_cleanly(
    world: World, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    handle = start(world, tmp_path, node("ends", output="'both'"))
    run(world, 1)
    assert console(capsys, tmp_path)[1:] == [
        "[ends-1] done",
        "[ends-1] no end",
        "[INFO] [ends-1]: process has finished cleanly [pid 1002]",
    ]
    assert not handle.running


def test_a_program_that_swallows_the_interrupt_is_terminated(
    world: World, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    handle = start(world, tmp_path, node("stubborn", output="'both'"))
    run(world, 1)
    handle.stop()
    assert console(capsys, tmp_path)[-1] == "[stubborn-1] no"
    assert handle.running
    run(world, 6)
    assert console(capsys, tmp_path)[-1] == (
        "[ERROR] [stubborn-1]: process has died [pid 1002, exit code -15, cmd 'lib/demo/stubborn --ros-args']."
    )
    assert not handle.running


def test_a_required_node_that_dies_in_robot_time_ends_the_rest(
    world: World, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    actions = node("talker", name="'a'") + node("raise_cb", name="'b'", on_exit="Shutdown()")
    head = HEAD.replace("from launch_ros", "from launch.actions import Shutdown\nfrom launch_ros")
    handle = start(world, tmp_path, actions, head)
    run(world, 2)
    lines = [line for line in console(capsys, tmp_path) if not line.startswith("[talker-1]  ")]
    first = next(number for number, line in enumerate(lines) if "process has died" in line)
    assert lines[first:] == [
        "[ERROR] [raise_cb-2]: process has died [pid 1003, exit code 1, cmd 'lib/demo/raise_cb --ros-args "
        "-r __node:=b'].",
        "[INFO] [launch]: process[raise_cb-2] was required: shutting down launched system",
        "[INFO] [talker-1]: sending signal 'SIGINT' to process[talker-1]",
        "[talker-1] Traceback (most recent call last):",
        "[talker-1] KeyboardInterrupt",
        "[ERROR] [talker-1]: process has died [pid 1002, exit code -2, cmd 'lib/demo/talker --ros-args -r __node:=a'].",
    ]
    assert not handle.running


def test_environment_variables_reach_the_programs_and_not_the_notebook(
    world: World, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLOUR", "red")
    monkeypatch.setenv("SHAPE", "round")
    actions = (
        node("surroundings", name="'before'")
        + "        SetEnvironmentVariable('COLOUR', 'blue'), SetEnvironmentVariable('SHAPE', 'flat'),\n"
        + "        SetEnvironmentVariable('RCUTILS_CONSOLE_OUTPUT_FORMAT', '{name}: {message}'),\n"
        + node("surroundings", name="'after'")
        + node("surroundings", name="'more'", additional_env="{'COLOUR': ['gr', 'een']}")
        + node("surroundings", name="'alone'", env="{'COLOUR': 'black'}.items()")
        + "        LogInfo(msg=EnvironmentVariable('COLOUR')),\n"
    )
    head = HEAD.replace(
        "def generate",
        "from launch.actions import LogInfo, SetEnvironmentVariable\n"
        "from launch.substitutions import EnvironmentVariable\n\ndef generate",
    )
    start(world, tmp_path, actions, head)
    run(world, 2)
    lines = console(capsys, tmp_path)
    assert "[INFO] [launch.user]: blue" in lines
    assert [line for line in lines if "sees" in line] == [
        "[surroundings-1] [INFO] [time] [before]: sees red round",
        "[surroundings-2] after: sees blue flat",
        "[surroundings-3] more: sees green flat",
        "[surroundings-4] [INFO] [time] [alone]: sees black None",
    ]
    assert os.environ["COLOUR"] == "red"
