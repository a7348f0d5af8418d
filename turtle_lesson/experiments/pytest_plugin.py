"""Tests of robots in many worlds: `@pytest.mark.worlds(seeds=100)` makes a test of each seed, in a fresh world of its own.

    # conftest.py
    pytest_plugins = ["turtle_lesson.experiments.pytest_plugin"]

    # test_robot.py
    @pytest.mark.worlds(seeds=100, package="my_robot", gain=[1.0, 2.0])
    def test_it_arrives(lesson, gain):
        lesson.launch("my_robot", "start.launch.py", gain=gain)
        ...

That is `test_it_arrives[gain=1.0-seed0]` and 199 more: `-k`, pytest-xdist and reports know them as any other test. A test that
takes `lesson` without the mark gets a world of seed 0. The plugin is not loaded by itself, since the lesson puts its packages
on `sys.path`.
"""

from __future__ import annotations

import inspect
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from .experiment import check_options, plan
from .one_run import ExperimentError, Run, Setting, open_run
from .replay import Surroundings

if TYPE_CHECKING:
    from ..session.lesson import Lesson

MARK = "worlds"

SETTING = {
    name: getattr(Setting(b""), name) for name in ("package", "distro", "start_order", "simulator", "robot_time")
}


def pytest_configure(config: pytest.Config) -> None:
    """Make the mark known."""
    config.addinivalue_line(
        "markers",
        f"{MARK}(seeds=10, package='finished', simulator=True, distro=None, start_order='as written', robot_time=600, "
        "**sweeps): run the test in a fresh world for each seed, and for each combination of the values of its parameters",
    )


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Make the tests of a mark."""
    mark = metafunc.definition.get_closest_marker(MARK)
    if mark is None:
        return
    name = metafunc.function.__name__
    try:
        if mark.args:
            raise ExperimentError(f"give what you mean by name: @pytest.mark.{MARK}(seeds={mark.args[0]!r})")
        if "lesson" not in metafunc.fixturenames:
            raise ExperimentError(f"it must take the world as its parameter: def {name}(lesson): …")
        runs, setting = _planned(metafunc, dict(mark.kwargs))
    except ExperimentError as error:
        pytest.fail(f"{name}, marked with @pytest.mark.{MARK}: {error}", pytrace=False)
    metafunc.parametrize(
        [*runs[0].parameters, "lesson"],
        [[*run.parameters.values(), (run, setting)] for run in runs],
        ids=["".join(f"{name}={value}-" for name, value in run.parameters.items()) + f"seed{run.seed}" for run in runs],
        indirect=["lesson"],
    )


def _planned(metafunc: pytest.Metafunc, given: dict[str, Any]) -> tuple[list[Run], Setting]:
    """The runs of a test in their order, and what they share. Raises ExperimentError."""
    seeds = given.pop("seeds", 10)
    seeds = range(seeds) if isinstance(seeds, int) and not isinstance(seeds, bool) else seeds
    setting = {name: given.pop(name, value) for name, value in SETTING.items()}
    package, root = setting["package"], metafunc.config.rootpath  # wherever pytest was started
    if isinstance(package, (str, Path)) and (root / package).is_dir():
        setting["package"] = str(root / package)
    accepted = inspect.signature(metafunc.function).parameters
    for name in given:
        if name not in accepted or accepted[name].default is not inspect.Parameter.empty:
            raise ExperimentError(f"{name} is no parameter of the test, or has a default, which pytest never replaces")
    check_options(**setting)
    return plan(seeds, given), Setting(b"", **setting)


@pytest.fixture
def lesson(request: pytest.FixtureRequest) -> Iterator[Lesson]:
    """A fresh world, which is closed at the end of the test: see `turtle_lesson.start`."""
    run, setting = getattr(request, "param", (Run(0, 0), Setting(b"")))
    with Surroundings().hold():
        opened = open_run(setting, run)
        try:
            yield opened
        finally:
            opened._world.close()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Say below a failure how to open its run in a notebook."""
    report = yield
    place = getattr(item, "callspec", None) and item.callspec.params.get("lesson")  # type: ignore[attr-defined]
    if report.when == "call" and report.failed and item.get_closest_marker(MARK) and place:
        run, setting = place
        given = {"seed": run.seed, **run.parameters}
        asked = {name: getattr(setting, name) for name in SETTING}
        given |= {name: value for name, value in asked.items() if value != SETTING[name]}
        function = item.originalname  # type: ignore[attr-defined]
        words = ", ".join([function, *(f"{name}={value!r}" for name, value in given.items())])
        report.sections.append(
            (
                "to go through it step by step in a notebook",
                f"from turtle_lesson.experiments import replay\nfrom {item.path.stem} import {function}\n"
                f"again = replay({words})\nagain.step(1.0)",
            )
        )
    return report
