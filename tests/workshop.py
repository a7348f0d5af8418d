"""A terminal in which packages of tests/data are built and sourced, beside the programs that every ROS 2 has."""

from __future__ import annotations

import math
import re
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
import rclpy
from turtlesim.msg import Pose

from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.idl.registry import forget_modules, registry
from turtle_lesson.ros.runtime.world import World
from turtle_lesson.session.lesson import underlay_packages

DATA = Path(__file__).parent / "data"
SECOND = 1_000_000_000
BUILT = 10
"""When (s) the building has ended for sure, and the programs are started."""

Place = tuple[float, float, float]


class Workshop:
    """A world with packages built and sourced; times are in s of robot time since then."""

    def __init__(self, world: World, capsys: pytest.CaptureFixture[str]) -> None:
        self.world = world
        self._capsys = capsys

    def say(self, *lines: str, seconds: float = 0.0) -> list[str]:
        """Type lines, let time pass, and return what was printed, as `1.5 node: text` where it is a log line."""
        for line in lines:
            run_line(self.world, line)
        self.run(seconds)
        printed = self._capsys.readouterr().out.splitlines()
        return [_short(line) for line in printed if "is still running. To stop it" not in line]

    def run(self, seconds: float) -> None:
        """Let robot time pass."""
        self.world.sim.run_until(self.world.now + round(seconds * SECOND))

    def watch(self, *turtles: str) -> dict[str, list[Place]]:
        """The poses (x, y, theta) of turtles from now on, each in its list, as they come."""
        seen: dict[str, list[Place]] = {turtle: [] for turtle in turtles}

        def watcher() -> None:
            rclpy.init(args=[])
            node = rclpy.create_node("watcher")
            for turtle, poses in seen.items():
                node.create_subscription(Pose, f"/{turtle}/pose", _noting(poses), 10)
            rclpy.spin(node)

        self.world.spawn(watcher, name="watcher")
        return seen


def _noting(poses: list[Place]) -> Callable[[Pose], None]:
    return lambda pose: poses.append((pose.x, pose.y, pose.theta))


def _short(line: str) -> str:
    found = re.fullmatch(r"(?:\[\S+-\d+\] )?\[(\w+)\] \[18000000(\d\d\.\d)\d+\] \[([\w.]+)\]: (.*)", line)
    if not found:
        return line
    level = "" if found[1] == "INFO" else f" {found[1]}"
    return f"{float(found[2]) - BUILT:.1f}{level} {found[3]}: {found[4]}"


def distance(one: Place, other: Place) -> float:
    """How far two places are from each other."""
    return math.hypot(one[0] - other[0], one[1] - other[1])


@contextmanager
def built(
    folder: str, world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Iterator[Workshop]:
    """Build the packages of a folder of tests/data, and forget them in the end."""
    for package in underlay_packages():
        world.packages.add(package)
    shutil.copytree(DATA / folder, tmp_path / "src")
    monkeypatch.chdir(tmp_path)
    assert run_line(world, "colcon build && source install/setup.bash") == 0
    world.sim.run_until(BUILT * SECOND)
    capsys.readouterr()
    yield Workshop(world, capsys)
    for package_xml in (tmp_path / "src").glob("*/package.xml"):
        forget_modules(package_xml.parent.name)
        if package_xml.parent.name in registry.packages():
            registry.remove(package_xml.parent.name)
