"""Where troubles are put on: what can be done to a world by public means, as somebody at its terminals could."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from .ros import launching
from .ros.command.jobs import Job, jobs
from .ros.command.shell import home
from .ros.console import CellOutput
from .ros.core import Process
from .ros.interfaces.registry import registry
from .ros.workspace.package import Package
from .sourced import HERE

if TYPE_CHECKING:
    from .lab.troubles import Program
    from .ros.world import World

WORKSPACE = "trouble_ws"
DRAFTS = HERE / "lab" / "troubles" / "robot_draft"
STAYS = frozenset({"lab", "turtlesim", "turtlesim_node"})
MESSAGE_LINE = '"msg/TurtleStatus.msg"'


class WorldStage:
    """A `Stage` (see lab/troubles/model.py) in a world of this notebook. `install` makes the finished package findable."""

    def __init__(self, world: World, install: Callable[[], None], finished: Path) -> None:
        self._world = world
        self._install = install
        self._finished = finished
        if "robot_draft" not in world.packages:
            files = {path.stem: path for path in sorted(DRAFTS.glob("*.py"))}
            world.packages.add(Package("robot_draft", DRAFTS, executables=dict(files)))

    @property
    def ended(self) -> bool:
        """Whether a newer `start()` has taken this world's place."""
        return self._world.sim.closed

    def clear(self) -> None:
        """Ctrl-C for every program but the simulator; the simulator and the finished package are there again."""
        for process in self._programs():
            if process.name not in STAYS:
                process.interrupt()
        self._world.sim.settle()
        for process in self._programs():
            if process.name not in STAYS:
                process.kill()
        if not any(process.name.startswith("turtlesim") for process in self._programs()):
            out = CellOutput(self._world.sim)
            target = self._world.packages.executable("turtlesim", "turtlesim_node")
            self._world.spawn(target, name="turtlesim", argv=["turtlesim_node"], stdout=out, stderr=out)
        if "robot_controller" not in self._world.packages:
            self._install()
        self._world.sim.settle()

    def _programs(self) -> list[Process]:
        return [process for process in self._world.processes if process.alive]

    def start(self, programs: tuple[Program, ...]) -> None:
        """Launch nodes: one launch, whose lines tell their pids, and which is a job as after `ros2 launch`."""
        if not programs:
            return
        from launch import LaunchDescription
        from launch_ros.actions import Node

        nodes = [
            Node(
                package=each.package,
                executable=each.executable,
                name=each.name or each.executable,
                output="screen",
                parameters=[each.parameters] if each.parameters else [],
                remappings=list(each.remaps.items()),
            )
            for each in programs
        ]
        handle = launching.launch_description(self._world, LaunchDescription(nodes))
        jobs(self._world).add(Job("ros2 launch trouble.launch.py", handle))
        handle.wait_until_up()

    def stop_simulator(self) -> None:
        """Ctrl-C for the turtle simulator."""
        for process in self._programs():
            if process.name.startswith("turtlesim"):
                process.interrupt()
        self._world.sim.settle()

    def make_workspace(self, fault: str) -> None:
        """A fresh workspace in the notebook's folder with the package in source; nowhere else is it found from now on."""
        folder = home() / WORKSPACE
        shutil.rmtree(folder, ignore_errors=True)
        source = folder / "src" / "robot_controller"
        shutil.copytree(self._finished, source, ignore=shutil.ignore_patterns("__pycache__"))
        if fault == "not in CMakeLists.txt":
            text = (source / "CMakeLists.txt").read_text(encoding="utf-8")
            assert MESSAGE_LINE in text, "the finished package names its message otherwise by now"
            (source / "CMakeLists.txt").write_text(text.replace(MESSAGE_LINE, ""), encoding="utf-8")
        if fault != "not built":
            self._build(folder)
        while "robot_controller" in self._world.packages:
            self._world.packages.remove("robot_controller")
        if "robot_controller" in registry.packages():
            registry.remove("robot_controller")

    def _build(self, folder: Path) -> None:
        """`colcon build`, which somebody has done before: nothing of it is shown."""
        import io

        from .ros.workspace import colcon

        said = io.StringIO()
        colcon.run(self._world, ["build"], stdout=said, stderr=said, cwd=folder)
