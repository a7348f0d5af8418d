"""A terminal in a workspace where the packages of `tests/data/programs` are built, for tests that type lines into it."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterable
from pathlib import Path

import pytest

from turtle_lesson.ros.cli.shell import run_line
from turtle_lesson.ros.idl.registry import forget_modules, registry
from turtle_lesson.ros.runtime.world import World

PACKAGES = Path(__file__).parent / "data" / "programs"
SECOND = 1_000_000_000
BUILT = 10
"""When (s) the building has ended for sure, and the programs are started."""


class Terminal:
    """Types lines, lets time pass, and tells what was printed. Times in log lines count from the start of the programs."""

    def __init__(self, world: World, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.world = world
        self.folder = folder
        self.codes: list[int] = []
        self._capsys = capsys
        self._packages: list[str] = []

    def build(self, *packages: str) -> None:
        """Build these packages, and source the workspace."""
        for name in packages:
            shutil.copytree(PACKAGES / name, self.folder / "src" / name)
        self._packages.extend(packages)
        assert run_line(self.world, "colcon build && source install/setup.bash") == 0, self._capsys.readouterr()
        self.world.sim.run_until(BUILT * SECOND)
        self._capsys.readouterr()

    def say(self, *lines: str, seconds: float = 0.0) -> list[str]:
        """What is printed from when these lines are typed until `seconds` later. Log lines read `0.5 name: text`."""
        self.codes = [run_line(self.world, line) for line in lines]
        self.world.sim.run_until(self.world.now + round(seconds * SECOND))
        return self.printed()

    def run(self, *programs: str, seconds: float = 0.0) -> list[str]:
        """What programs print that are started with `ros2 run`: "package program arguments"."""
        return self.say(*(f"ros2 run {each}" for each in programs), seconds=seconds)

    def printed(self) -> list[str]:
        """What was printed since the last look, to either stream."""
        found = self._capsys.readouterr()
        lines = [*found.out.splitlines(), *found.err.splitlines()]
        return [_short(line) for line in lines if "is still running. To stop it" not in line]

    def exit_codes(self) -> list[int | None]:
        """How each program ended, None for those that still run."""
        return [process.exit_code for process in self.world.processes]

    def interrupt(self, seconds: float = 0.1) -> list[str]:
        """Press Ctrl-C in all programs; what they print then."""
        for process in self.world.processes:
            if process.exit_code is None:
                process.interrupt()
        return self.say(seconds=seconds)

    def close(self) -> None:
        """Forget the packages."""
        for name in self._packages:
            forget_modules(name)
            if name in registry.packages():
                registry.remove(name)


def having(lines: Iterable[str], *parts: str) -> list[str]:
    """The lines with any of these parts."""
    return [line for line in lines if any(part in line for part in parts)]


def _short(line: str) -> str:
    found = re.fullmatch(r"(.*)\[(\w+)\] \[18000000(\d\d)\.(\d)\d+\] \[([\w./]+)\]: (.*)", line)
    if not found:
        return line
    source, level, seconds, tenths, name, text = found.groups()
    begin = f"{source}{int(seconds) - BUILT}.{tenths} {name}"
    return f"{begin}: {text}" if level == "INFO" else f"{begin} {level}: {text}"
