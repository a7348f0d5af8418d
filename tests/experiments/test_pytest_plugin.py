"""The pytest plugin: a test for each seed and combination, each in a world of its own, and clear words for a wrong mark."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

pytest_plugins = ["pytester"]

PLUGIN = ("-p", "turtle_lesson.experiments.pytest_plugin", "-p", "no:cacheprovider", "--strict-markers", "-W", "error")

TESTS = """\
import random

import pytest

seen = []


@pytest.mark.worlds(seeds=3, simulator=False)
def test_seeds(lesson):
    assert lesson.now == 0
    lesson.run(0.5)
    seen.append(lesson)
    assert all(other._world.sim.closed for other in seen[:-1])
    assert random.random() == random.Random(lesson._world.seed).random()
    print("in world", lesson._world.seed)
    assert lesson._world.seed != 1, "the turtle did not arrive"


@pytest.mark.worlds(seeds=[17, 4], order=["as written", "shuffled"], gain=[1.0, 2.5], start_order="shuffled", simulator=False)
def test_sweeps(lesson, order, gain, tmp_path):
    assert gain in (1.0, 2.5) and tmp_path.exists()
    assert lesson._world.seed in (4, 17)


@pytest.mark.worlds(seeds=1, robot_time=2)
def test_limit(lesson):
    lesson.run(3)


def test_no_mark(lesson):
    assert lesson._world.seed == 0
    lesson.launch("robot_controller", "start_system.launch.py")
"""


WRONG = {
    "seeds=0": "seeds must be one or more whole numbers, got range(0, 0)",
    "seeds='many'": "seeds must be one or more whole numbers, got 'many'",
    "5": "give what you mean by name: @pytest.mark.worlds(seeds=5)",
    "gian=[1.0]": "gian is no parameter of the test",
    "rate=[1.0]": "rate is no parameter of the test, or has a default, which pytest never replaces",
    "gain=[]": "gain must be one or more numbers",
    "distro='indigo'": "distro must be one of the releases",
    "package='nowhere'": 'package must be "finished", "mine", None or the folder of a package, got \'nowhere\'',
    "start_order='random'": "start_order must be",
    "robot_time=-1": "robot_time must be a number of seconds above 0, got -1",
}
HEAD = "import pytest\n\n@pytest.mark.worlds"


@pytest.fixture(autouse=True)
def this_checkout(monkeypatch: pytest.MonkeyPatch) -> None:
    """The processes that a test starts import the code beside this file."""
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[2]))
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")  # those of the notebooks take long to import


def test_each_seed_is_a_test_in_a_world_of_its_own_and_a_wrong_mark_is_a_sentence(pytester: pytest.Pytester) -> None:
    wrong = {
        f"test_{number}": f"{HEAD}({mark})\ndef test_wrong(lesson, gain, rate=1.0): pass\n"
        for number, mark in enumerate(WRONG)
    }
    pytester.makepyfile(test_robot=TESTS, test_none=f"{HEAD}(seeds=2)\ndef test_wrong(): pass\n", **wrong)
    result = pytester.runpytest_subprocess(*PLUGIN, "-rA", "--continue-on-collection-errors", "-p", "xdist", "-n", "1")
    result.assert_outcomes(passed=11, failed=2, errors=len(WRONG) + 1)
    said = result.stdout.str()
    names = re.findall(r"^(PASSED|FAILED) test_robot\.py::(.+?)(?: - .*)?$", said, re.MULTILINE)
    assert sorted(names) == sorted(
        [
            ("FAILED", "test_seeds[seed1]"),
            ("FAILED", "test_limit[seed0]"),
            *(("PASSED", name) for name in ("test_no_mark", "test_seeds[seed0]", "test_seeds[seed2]")),
            *(
                ("PASSED", f"test_sweeps[order={order}-gain={gain}-seed{seed}]")
                for gain in (1.0, 2.5)
                for order in ("as written", "shuffled")
                for seed in (17, 4)
            ),
        ]
    )
    assert "in world 1" in said
    assert "again = replay(test_seeds, seed=1, simulator=False)" in said
    for sentence in WRONG.values():
        assert f"test_wrong, marked with @pytest.mark.worlds: {sentence}" in said
    assert "it must take the world as its parameter: def test_wrong(lesson): …" in said
    assert "OutOfTime: its world ended, at 2 s of robot time" in said
