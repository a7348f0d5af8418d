"""A world in which no program really runs: a launch test says what its processes print and do."""

from __future__ import annotations

import heapq
import sys
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import turtle_lesson  # noqa: F401  (makes launch and launch_ros importable)
from turtle_lesson.ros.ament.index import PackageIndex
from turtle_lesson.ros.ament.package import Package
from turtle_lesson.ros.launching.service import LaunchHandle, launch_file


class FakeSimulation:
    """A clock with timed calls."""

    def __init__(self) -> None:
        self.now = 0
        self._heap: list[tuple[int, int, Callable[[], Any]]] = []

    @property
    def cell_stdout(self) -> Any:
        return sys.stdout

    def call_later(self, delay: int, function: Callable[..., Any], *arguments: Any) -> None:
        heapq.heappush(self._heap, (self.now + delay, len(self._heap), lambda: function(*arguments)))

    def run_until(self, time: int) -> None:
        while self._heap and self._heap[0][0] <= time:
            self.now, _, function = heapq.heappop(self._heap)
            function()
        self.now = time


class FakeProcess:
    """A process that prints and ends when a test says so. A stubborn one ignores SIGINT."""

    def __init__(self, pid: int, details: dict[str, Any]) -> None:
        self.pid = pid
        self.name = details["name"]
        self.argv = details["argv"]
        self.target = details["target"]
        self.stdout = details["stdout"]
        self.stderr = details["stderr"]
        self.exit_code: int | None = None
        self.stubborn = False
        self._on_exit = details["on_exit"]

    @property
    def alive(self) -> bool:
        return self.exit_code is None

    def end(self, code: int) -> None:
        if self.exit_code is None:
            self.exit_code = code
            self._on_exit(self)

    def interrupt(self) -> None:
        if not self.stubborn:
            self.stderr.write("KeyboardInterrupt\n")
            self.end(-2)

    def kill(self) -> None:
        self.end(-9)

    def send_signal(self, number: int) -> None:
        self.end(-number)


class FakeWorld:
    """What `launching` needs of a world."""

    def __init__(self, package: Package | None = None) -> None:
        self.sim = FakeSimulation()
        self.packages = PackageIndex()
        self.processes: list[FakeProcess] = []
        self.at_close: list[Any] = []
        self.start_order = None
        self.packages.add(package or robot_package())

    def spawn(self, target: Any, **details: Any) -> FakeProcess:
        process = FakeProcess(1001 + len(self.processes), {"target": target, **details})
        self.processes.append(process)
        return process

    def run(self, seconds: float) -> None:
        self.sim.run_until(self.sim.now + round(seconds * 1e9))

    def argv(self, index: int = -1) -> list[str]:
        """A process's arguments after the program's name."""
        return self.processes[index].argv[1:]


def robot_package() -> Package:
    """The lesson's package with its three executables, installed in a folder that exists on paper only."""
    prefix = Path("install/robot_controller")
    names = ("navigator", "status_monitor", "obstacle_detector")
    return Package(
        "robot_controller",
        prefix / "share/robot_controller",
        executables={name: prefix / "lib/robot_controller" / name for name in names},
        prefix=prefix,
    )


HEAD = """
from launch import *
from launch.actions import *
from launch.conditions import *
from launch.event_handlers import *
from launch.substitutions import *
from launch.launch_description_sources import *
from launch_ros.actions import *
from launch_ros.descriptions import *
from launch_ros.substitutions import *

def generate_launch_description():
    return LaunchDescription([
"""


def write_launch_file(folder: Path, actions: str, name: str = "test.launch.py") -> Path:
    """A launch file whose description is this list of actions."""
    body = textwrap.indent(textwrap.dedent(actions).strip(), "        ")
    return write(folder, f"{HEAD}{body}\n    ])\n", name)


def write(folder: Path, text: str, name: str = "test.launch.py") -> Path:
    """A file with this text."""
    path = folder / name
    path.write_text(textwrap.dedent(text), encoding="utf-8")
    return path


def launch(folder: Path, actions: str, **arguments: object) -> tuple[FakeWorld, LaunchHandle]:
    """Launch a list of actions in a fresh world."""
    world = FakeWorld()
    handle = launch_file(cast(Any, world), write_launch_file(folder, actions), arguments)
    return world, handle


def node(executable: str = "navigator", **more: str) -> str:
    """The text of a Node action; keyword values are Python text."""
    words = "".join(f", {name}={value}" for name, value in more.items())
    return f"Node(package='robot_controller', executable='{executable}'{words}),\n"
