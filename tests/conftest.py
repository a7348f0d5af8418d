"""What tests share: a fresh world for each test, and programs that run in it as processes of their own."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

# Before ours: hypothesis measures garbage collections with time.perf_counter. Were that the simulated one, a collection
# in the middle of a simulated process would be a look at its clock.
import hypothesis.internal.conjecture.junkdrawer  # noqa: F401
import pytest
from answers.client import PageServer
from hypothesis import HealthCheck, settings
from program_terminal import Terminal

import turtle_lesson  # noqa: F401  (makes rclpy and the interface packages importable in every test)
from turtle_lesson.ros.idl.registry import forget_modules, registry
from turtle_lesson.ros.runtime import files
from turtle_lesson.ros.runtime.world import World, open_world
from turtle_lesson.session.lesson import underlay_packages

# A busy machine is no reason to fail: what hypothesis would refuse by its clock, CI or not, is taken. Fixtures may serve
# several examples. Each run tries others; a long search is `TURTLE_LESSON_EXAMPLES=1000 pytest -m hypothesis tests`.
settings.register_profile(
    "patient",
    deadline=None,
    suppress_health_check=list(HealthCheck),
    max_examples=int(os.environ.get("TURTLE_LESSON_EXAMPLES", 20)),
)
settings.load_profile("patient")

SECOND = 1_000_000_000

Program = Callable[[list[Any]], object]


@pytest.fixture(autouse=True, scope="module")
def no_package_of_another_module() -> None:
    """Forget the `robot_controller` that tests of another module have built, sourced or imported."""
    if "robot_controller" in registry.packages():
        registry.remove("robot_controller")
    forget_modules("robot_controller")


@pytest.fixture(autouse=True)
def no_folder_of_another_test(monkeypatch: pytest.MonkeyPatch) -> None:
    """The learner's folder is the one that is current when a test first asks for it, or calls `start()`."""
    monkeypatch.setattr(files, "_home", None)
    monkeypatch.setattr(files, "_of_notebook", False)


@pytest.fixture(scope="session")
def page_server() -> Iterator[PageServer]:
    """Runs pages in forks of one process."""
    server = PageServer()
    yield server
    server.close()


@pytest.fixture
def world(monkeypatch: pytest.MonkeyPatch) -> Iterator[World]:
    """A fresh world, closed after the test. The test may choose its folder after that."""
    world = open_world()
    monkeypatch.setattr(files, "_home", None)
    yield world
    world.close()


@pytest.fixture
def run(world: World) -> Callable[..., list[Any]]:
    """Returns `run(program, …, seconds=10.0)`: runs programs side by side, as processes of the fresh world.

    Each program gets the one list that `run` returns, to put in it what it finds. An error that ends a program is
    raised in the test.
    """

    def run(*programs: Program, seconds: float = 10.0) -> list[Any]:
        found: list[Any] = []
        processes = [world.spawn(_with(program, found), name=program.__name__) for program in programs]
        world.sim.run_until(world.now + round(seconds * SECOND))
        for process in processes:
            if process.error is not None:
                raise process.error
        return found

    return run


@pytest.fixture
def empty_terminal(
    world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Iterator[Terminal]:
    """A terminal in an empty folder."""
    monkeypatch.chdir(tmp_path)
    terminal = Terminal(world, tmp_path, capsys)
    yield terminal
    terminal.close()


@pytest.fixture
def terminal(empty_terminal: Terminal) -> Terminal:
    """A terminal where first_steps is built."""
    empty_terminal.build("first_steps")
    return empty_terminal


@pytest.fixture
def fresh_terminal(empty_terminal: Terminal) -> Terminal:
    """A terminal of a fresh ROS 2, with the simulator and the demos."""
    for package in underlay_packages():
        empty_terminal.world.packages.add(package)
    return empty_terminal


def _with(program: Program, found: list[Any]) -> Callable[[], object]:
    return lambda: program(found)
