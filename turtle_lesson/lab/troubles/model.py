"""What a trouble is: a symptom, and faults that it may come from, one of which is put into the world."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from random import Random
from typing import Any, Protocol

from ..checks import Expectation


@dataclass(frozen=True)
class Program:
    """A node to start, as a launch file would."""

    executable: str
    package: str = "robot_controller"
    name: str = ""
    parameters: dict[str, Any] = field(default_factory=dict)
    remaps: dict[str, str] = field(default_factory=dict)


NAVIGATOR, MONITOR, DETECTOR = Program("navigator"), Program("status_monitor"), Program("obstacle_detector")


@dataclass(frozen=True)
class Fault:
    """What is wrong, and how it comes into the world.

    Attributes:
        cause: what it is, told when it is mended.
        hint: the last hint, which nearly tells it.
        programs: the nodes that run.
        simulator: whether the turtle simulator runs.
        workspace: what is wrong with the workspace `trouble_ws`; nothing if there is none.
    """

    cause: str
    hint: str
    programs: tuple[Program, ...]
    simulator: bool = True
    workspace: str = ""


@dataclass(frozen=True)
class Trouble:
    """A symptom and where it may come from.

    Attributes:
        name: by which `lesson.trouble(name=…)` asks for it.
        report: what a user says.
        hints: where to look first, then with what.
        commands: those that show what is wrong, from outside.
        choose: chooses a fault by chance.
        expectations: what is so in a well system.
    """

    name: str
    report: str
    hints: tuple[str, str]
    commands: tuple[str, ...]
    choose: Callable[[Random], Fault]
    expectations: Callable[[], list[Expectation]]


class Stage(Protocol):
    """Where a trouble is put on: what can be done to a world by public means."""

    def clear(self) -> None:
        """End every program but the simulator; the simulator and the package are there again, as before."""

    def start(self, programs: tuple[Program, ...]) -> None:
        """Launch nodes."""

    def stop_simulator(self) -> None:
        """Ctrl-C for the turtle simulator."""

    def make_workspace(self, fault: str) -> None:
        """Copy the package's source into the workspace `trouble_ws`; from now on the package is found nowhere else."""

    @property
    def ended(self) -> bool:
        """Whether a newer world has taken its place."""
