"""Puts troubles into a world by public means, as from its terminals: programs, remappings, broken files."""

from __future__ import annotations

import io
import os
import re
import shutil
from pathlib import Path
from typing import TYPE_CHECKING

from ..learner.story import FINISHED, HERE
from ..ros.ament.package import Package, PythonProgram, Target
from ..ros.ament.source import overlay, overlays, remove_all, use_source
from ..ros.cli import colcon
from ..ros.cli.jobs import jobs
from ..ros.idl.names import module_name
from ..ros.idl.registry import registry
from ..ros.runtime.files import home
from ..ros.sim.process import Process
from .live import OfWorld, start_simulator

if TYPE_CHECKING:
    from ..lab.troubles.faults import Program
    from ..ros.runtime.world import World

PACKAGE = "robot_controller"
WORKSPACE = "trouble_ws"
MARK = ".made_for_a_case"
"""An empty file in a `trouble_ws` that was made here: only such a folder is ever replaced."""

DRAFTS = HERE / "lab" / "troubles" / "robot_draft"
SMALL_NODES = ("Laser", "ObstacleAlarm", "SpeedLimiter", "StatusText", "StatusTwice")
"""The programs of robot_draft that are a class in its `small_nodes.py`; the others are files."""

STAYS = frozenset({"lab", "turtlesim", "turtlesim_node"})
MESSAGE_FILE = re.compile(r'"?\bmsg/TurtleStatus\.msg"?')


class _SourcedBefore(list[Path]):
    """The install folders that were sourced when a world's first case was opened."""


class TroubleEnvironment(OfWorld):
    """What a trouble (see lab/troubles/cases.py) is put into: a world of this notebook.

    Where the learner's own package is sourced when the first case is opened, the cases are about that one. Its files are
    only read: what is to be broken in files is broken in a copy, which goes with the next case and with the world.
    """

    def __init__(self, world: World) -> None:
        super().__init__(world)
        sourced = list(dict.fromkeys(install for install, _ in overlays(world)))
        self._sourced = world.notebook.state(_SourcedBefore, sourced)
        if "robot_draft" not in world.packages:
            programs: dict[str, Target] = {path.stem: path for path in DRAFTS.glob("navigator_*.py")}
            for node in SMALL_NODES:
                name = module_name(node).removeprefix("_")
                code = f"import small_nodes\nsmall_nodes.run(small_nodes.{node})\n"
                programs[name] = PythonProgram(DRAFTS / name, (), code)
            world.packages.add(Package("robot_draft", DRAFTS, executables=programs))

    def clear(self) -> None:
        """Ctrl-C for every program but the simulator; the simulator and the package are there again, as before."""
        for process in self._programs():
            if process.name not in STAYS:
                process.interrupt()
        self._world.sim.settle()
        for process in self._programs():
            if process.name not in STAYS:
                process.kill()
        if not any(process.name.startswith("turtlesim") for process in self._programs()):
            start_simulator(self._world)
        remove_all(self._world)
        remove_scratch()
        for folder in self._sourced:
            overlay(self._world, folder)
        if PACKAGE not in self._world.packages:
            use_source(self._world, FINISHED)
        self._world.sim.settle()

    def _programs(self) -> list[Process]:
        return [process for process in self._world.processes if process.alive]

    def start(self, programs: tuple[Program, ...]) -> None:
        """Launch nodes: one launch, whose lines tell their pids, and which is a job as after `ros2 launch`."""
        if not programs:
            return
        from launch import LaunchDescription
        from launch_ros.actions import Node

        from ..ros.launching import service

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
        handle = service.launch_description(self._world, LaunchDescription(nodes))
        jobs(self._world).add("ros2 launch trouble.launch.py", handle)
        handle.wait_until_up()

    def stop_simulator(self) -> None:
        """Ctrl-C for the turtle simulator."""
        for process in self._programs():
            if process.name.startswith("turtlesim"):
                process.interrupt()
        self._world.sim.settle()

    def make_workspace(self, fault: str) -> None:
        """Copy the package's source into the workspace `trouble_ws`; from now on the package is found nowhere else.

        Raises FileExistsError for a `trouble_ws` that was not made here, ValueError for a package without the message.
        """
        folder = home() / WORKSPACE
        if folder.exists():
            raise FileExistsError(f"{WORKSPACE} is a folder of your own: give it another name, then run this again")
        written = self._world.packages.get(PACKAGE).source
        assert written is not None, "what is sourced here was built here, or lies in its source folder"
        source = folder / "src" / PACKAGE
        shutil.copytree(written, source, ignore=shutil.ignore_patterns("__pycache__"))
        (folder / MARK).touch()
        self._world.notebook.at_exit.append(remove_scratch)
        if fault == "not in CMakeLists.txt":
            text = (source / "CMakeLists.txt").read_text(encoding="utf-8")
            if not MESSAGE_FILE.search(text):
                raise ValueError(
                    'your CMakeLists.txt does not name "msg/TurtleStatus.msg", so this case cannot be made from it'
                )
            (source / "CMakeLists.txt").write_text(MESSAGE_FILE.sub("", text), encoding="utf-8")
        if fault != "not built":
            said = io.StringIO()  # a build of an earlier day: nothing of it is shown
            colcon.run(self._world, ["build"], stdout=said, stderr=said, cwd=folder)
        remove_all(self._world)
        while PACKAGE in self._world.packages:
            self._world.packages.remove(self._world.packages.get(PACKAGE))
        if PACKAGE in registry.packages():
            registry.remove(PACKAGE)


def remove_scratch() -> None:
    """Delete the `trouble_ws` that a case has made; a terminal that is in it goes back to its first folder."""
    folder = home() / WORKSPACE
    if (folder / MARK).is_file():
        if Path.cwd().is_relative_to(folder):
            os.chdir(home())
        shutil.rmtree(folder, ignore_errors=True)
