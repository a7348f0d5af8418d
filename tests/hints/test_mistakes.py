"""What learners do wrong: each time the real one's own words, and below them a sentence that helps.

`tests/data/mistakes.txt` holds the programs and the end of what they print. `HEAD` stands above each of them, unless it
begins with imports of its own.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path

import pytest

from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.idl.registry import forget_modules, registry
from turtle_lesson.ros.runtime.world import World
from turtle_lesson.ros.sim.errors import format_error

FILE = Path(__file__).parents[1] / "data" / "mistakes.txt"
HEAD = """\
import rclpy
from rclpy.node import Node
from std_msgs.msg import String
from example_interfaces.srv import AddTwoInts
from geometry_msgs.msg import Twist
"""
NODE = """\
import rclpy
from rclpy.node import Node


class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.get_logger().info('{text}')


def main():
    rclpy.init()
    Talker()
"""


def cases() -> Iterator[tuple[str, str, list[str]]]:
    """Title, program, and the last lines that it prints."""
    for block in FILE.read_text(encoding="utf-8").split("=== ")[1:]:
        title, _, rest = block.partition("\n")
        program, _, end = rest.partition("\n---\n")
        yield title, program, end.strip("\n").split("\n")


@pytest.mark.parametrize(("title", "program", "end"), [pytest.param(*case, id=case[0]) for case in cases()])
def test_a_mistake_is_explained(
    world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, title: str, program: str, end: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    path, out = tmp_path / "program.py", io.StringIO()
    path.write_text(program if program.startswith(("import", "from")) else HEAD + program, encoding="utf-8")
    process = world.spawn(path, name="program", argv=["program.py"], stdout=out, stderr=out)
    world.sim.run_until(20_000_000_000)
    said = out.getvalue()
    for newer in (
        " and no __dict__ for setting new attributes",
        ". Did you forget to import 'math'",
    ):  # words of 3.13, 3.12
        said = said.replace(newer, "")
    lines = said.splitlines()
    assert lines[0] == "Traceback (most recent call last):"
    assert lines[-len(end) :] == end
    assert process.exit_code == 1


def test_advice_is_given_once_and_only_to_what_is_known() -> None:
    error = AttributeError("something else")
    assert (
        format_error(error)
        == format_error(error)
        == "Traceback (most recent call last):\nAttributeError: something else\n"
    )
    error = ModuleNotFoundError("No module named 'rospy'", name="rospy")
    assert format_error(error).count("in ROS 2 it is rclpy") == format_error(error).count("in ROS 2 it is rclpy") == 1


class Workspace:
    """A terminal in a workspace with the package demo, and what the last line printed to stderr."""

    def __init__(self, world: World, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.world, self.folder, self._capsys = world, folder, capsys
        self.code = 0
        (folder / "src").mkdir()
        self.type("cd src", "ros2 pkg create --build-type ament_python --node-name talker demo", "cd ..")
        self.write("demo/talker.py", NODE.format(text="one"))

    def write(self, name: str, text: str) -> None:
        path = self.folder / "src/demo" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)

    def change(self, name: str, old: str, new: str) -> None:
        path = self.folder / "src/demo" / name
        assert old in path.read_text()
        path.write_text(path.read_text().replace(old, new))

    def type(self, *lines: str) -> str:
        self._capsys.readouterr()
        for line in lines:
            self.code = run_line(self.world, line)
            self.world.sim.run_until(self.world.now + 1_000_000_000)
        found = self._capsys.readouterr()
        return found.err + found.out

    def build(self) -> str:
        return self.type("colcon build", "source install/setup.bash")


@pytest.fixture
def workspace(
    world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Iterator[Workspace]:
    monkeypatch.chdir(tmp_path)
    yield Workspace(world, tmp_path, capsys)
    forget_modules("demo")
    if "demo" in registry.packages():
        registry.remove("demo")


def test_forgot_to_build_and_to_source(workspace: Workspace) -> None:
    hint = "Package 'demo' not found\nIs it built (colcon build), and is its setup file sourced?\n"
    assert workspace.type("ros2 run demo talker") == hint
    workspace.type("colcon build")
    assert workspace.type("ros2 run demo talker") == hint and workspace.code == 1


def test_forgot_to_build_again(workspace: Workspace) -> None:
    workspace.build()
    workspace.change("demo/talker.py", "one", "two")
    hint = "src/demo/demo/talker.py was changed after the build: run colcon build to use the new version.\n"
    printed = workspace.type("ros2 run demo talker")
    assert printed.startswith(hint) and "[talker]: one" in printed
    workspace.build()
    assert workspace.type("ros2 run demo talker").endswith("[talker]: two\n")


def test_forgot_the_entry_point(workspace: Workspace) -> None:
    workspace.write("demo/hearer.py", NODE.format(text="hear"))
    workspace.build()
    assert workspace.type("ros2 run demo hearer") == (
        "No executable found\n"
        "demo has: talker. For hearer.py add 'hearer = demo.hearer:main' to console_scripts in setup.py, and build again.\n"
    )


def test_misspelt_an_executable(workspace: Workspace) -> None:
    workspace.build()
    assert workspace.type("ros2 run demo talkr") == "No executable found\nDid you mean 'talker'? demo has: talker.\n"


def test_an_entry_point_with_a_wrong_function(workspace: Workspace) -> None:
    workspace.change("setup.py", "demo.talker:main", "demo.talker:mian")
    assert "Hint: entry point 'talker': demo.talker has no mian(), so `ros2 run` will fail." in workspace.build()
    printed = workspace.type("ros2 run demo talker")
    assert "AttributeError: module 'demo.talker' has no attribute 'mian'" in printed
    assert printed.endswith("Did you mean 'main'?\n[ros2run]: Process exited with failure 1\n")


def test_an_entry_point_with_a_wrong_module(workspace: Workspace) -> None:
    workspace.change("setup.py", "demo.talker:main", "demo.talk:main")
    workspace.build()
    printed = workspace.type("ros2 run demo talker")
    assert "ModuleNotFoundError: No module named 'demo.talk'\nDid you mean 'talker'?\n" in printed


def test_an_entry_point_without_a_function(workspace: Workspace) -> None:
    workspace.change("setup.py", "demo.talker:main", "demo.talker")
    assert "Hint: It looks like 'my_node = demo.my_node:main'." in workspace.type("colcon build")
    assert workspace.code == 1


def test_a_launch_file_that_is_not_installed(workspace: Workspace) -> None:
    workspace.write("launch/all.launch.py", "")
    workspace.build()
    assert workspace.type("ros2 launch demo all.launch.py").splitlines()[1] == (
        "The file is in launch/, but it is not installed: add ('share/demo/launch', ['launch/all.launch.py']) to data_files in "
        "setup.py and build again."
    )


def test_a_launch_file_without_return(workspace: Workspace) -> None:
    text = "from launch import LaunchDescription\ndef generate_launch_description():\n    LaunchDescription([])\n"
    workspace.write("launch/all.launch.py", text)
    printed = workspace.type("ros2 launch src/demo/launch/all.launch.py")
    assert "generate_launch_description() must end with: return LaunchDescription([…])" in printed


def test_two_nodes_of_one_name(workspace: Workspace) -> None:
    workspace.change("demo/talker.py", "    Talker()", "    rclpy.spin(Talker())")
    workspace.build()
    workspace.type("ros2 run demo talker", "ros2 run demo talker")
    assert "nodes in the graph that share an exact name" in workspace.type("ros2 node list")


REFUSED = {
    "nav2_simple_commander.robot_navigator": "nav2_simple_commander is a package of ROS 2 that is not available here",
    "py_trees_ros": "py_trees_ros is a package of ROS 2 that is not available here",
    "interactive_markers": "interactive_markers is a package of ROS 2 that is not available here",
    "PyQt5.QtWidgets": "ImportError: PyQt5 opens windows, and a program here has no screen for them: lesson.dashboard()",
    "pygame": "ImportError: pygame opens windows, and a program here has no screen for them: lesson.dashboard()",
}


@pytest.mark.parametrize("module", REFUSED)
def test_what_is_not_here_is_refused_at_import_and_the_rest_of_a_launch_goes_on(
    workspace: Workspace, module: str
) -> None:
    workspace.write("lost.py", f"import {module}\nprint('never')\n")
    workspace.write("there.py", "import time\ntime.sleep(0.1)\nprint('the rest goes on')\n")
    workspace.write(
        "two.launch.py",
        "import os, sys\nfrom launch import LaunchDescription\nfrom launch.actions import ExecuteProcess\n"
        "here = os.path.dirname(__file__)\n"
        "def generate_launch_description():\n"
        "    names = ('lost.py', 'there.py')\n"
        "    run = [ExecuteProcess(cmd=[sys.executable, os.path.join(here, name)], output='screen') for name in names]\n"
        "    return LaunchDescription(run)\n",
    )
    printed = workspace.type("ros2 launch src/demo/two.launch.py")
    assert REFUSED[module] in printed
    assert "the rest goes on" in printed and "never" not in printed


def test_a_window_of_tkinter_is_refused_and_its_import_is_not(workspace: Workspace) -> None:
    pytest.importorskip("tkinter")
    workspace.write("window.py", "from tkinter import Y, Tk\nprint('imported', Y)\nTk()\n")
    printed = workspace.type("python3 src/demo/window.py")
    assert "imported y" in printed
    assert "RuntimeError: tkinter opens windows, and a program here has no screen for them" in printed
