"""The example project of a robot's own CI: its workflow names what is there, and its tests pass, and fail where they should."""

from __future__ import annotations

import random
import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from turtle_lesson import start

ROOT = Path(__file__).parents[2]
PROJECT = ROOT / "deploy" / "robot_ci"


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy, whose processes import the code of this checkout."""
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")  # those of the notebooks take long to import
    return Path(shutil.copytree(PROJECT, tmp_path / "robot", ignore=shutil.ignore_patterns("__pycache__")))


def test_the_workflow_runs_what_is_there(project: Path) -> None:
    steps = yaml.safe_load((project / ".github/workflows/robot.yml").read_text())["jobs"]["worlds"]["steps"]
    commands = [step["run"] for step in steps if "run" in step]
    assert [command.partition(" -")[0].split()[-1] for command in commands] == [
        "python",
        "python",
        "experiments/turning.py",
    ]
    shown = re.search(r"```sh\n(.*?)```", (project / "README.md").read_text(), re.DOTALL)
    assert shown is not None
    assert [command.replace(" --junit-xml tests.xml", "") for command in commands] == shown[1].splitlines()
    for name in ("requirements.txt", "experiments/turning.py"):
        assert any(name in command for command in commands) and (project / name).is_file()


@pytest.mark.filterwarnings("ignore::pytest.PytestUnknownMarkWarning")
def test_its_tests_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(PROJECT / "src/patrol")
    tests = runpy.run_path(str(PROJECT / "tests/test_patrol.py"))
    for name in ("test_it_patrols_from_anywhere_whichever_node_is_up_first", "test_it_goes_on_when_messages_are_lost"):
        given = dict(tests[name].pytestmark[0].kwargs)
        loss = {"loss": given["loss"][-1]} if "loss" in given else {}
        random.seed(0)
        world = {name: value for name, value in given.items() if name not in ("seeds", "loss", "package")}
        tests[name](start(0, PROJECT / given["package"], **world), **loss)
    tests["test_it_turns_the_short_way"](3.0)


def test_they_find_a_message_that_comes_too_early(project: Path) -> None:
    planner = project / "src/patrol/patrol/planner.py"
    planner.write_text(planner.read_text().replace("DurabilityPolicy.TRANSIENT_LOCAL", "DurabilityPolicy.VOLATILE"))
    chosen = "anywhere and (seed0 or seed2)"
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", chosen]
    said = subprocess.run(command, cwd=project, capture_output=True, text=True).stdout
    assert "first[seed0]" in said and re.search(r"^1 failed, 1 passed", said, re.MULTILINE), said
    again = f"seed=0, package={str(project / 'src/patrol')!r}, "
    assert f"again = replay(test_it_patrols_from_anywhere_whichever_node_is_up_first, {again}" in said
