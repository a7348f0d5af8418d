"""`turtle-lesson run`: an experiment from a terminal, for people's own CI."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import pandas
import pytest

from turtle_lesson.experiments.one_run import Ending, Run
from turtle_lesson.teaching.main import main

SCRIPT = """\
import sys
from pathlib import Path
from helpers import double
from turtle_lesson.experiments import experiment

def drive(lesson, gain):
    assert gain < 3, "too much"
    return {"doubled": double(gain)}

print(__name__, sys.argv)
for gains in ([1], [2, 3])[: int(Path("how_many.txt").read_text())]:
    experiment(drive, seeds=range(2), gain=gains, simulator=False)
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "check.py").write_text(SCRIPT)
    (tmp_path / "robot" / "helpers.py").write_text("def double(gain):\n    return 2 * gain\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_its_tables_are_printed_and_saved_and_the_exit_code_tells_of_failures(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "how_many.txt").write_text("2")
    before = sys.argv[:], sys.path[:]
    assert main(["run", "robot/check.py", "--jobs", "1", "--csv", "runs.csv"]) == 1
    assert (sys.argv, sys.path) == before
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "__main__ ['robot/check.py']"
    assert [line for line in lines if "run" in line and "failed" in line] == [
        "2 runs, none failed",
        "4 runs, 2 failed: 2, 3",
    ]
    assert [line for line in lines if line.startswith("saved")] == ["saved as runs.csv", "saved as runs-2.csv"]
    assert list(pandas.read_csv("runs.csv", comment="#")["doubled"]) == [2, 2]
    assert list(pandas.read_csv("runs-2.csv", comment="#")["error"])[2] == "AssertionError: too much"


class Well:
    """Stands for the worker processes: each run ends well."""

    def __init__(self, setting: Any, jobs: int) -> None:
        assert jobs == 1

    def carry_out(self, runs: list[Run]) -> Any:
        return [(run, Ending("ok", {}, 1.0)) for run in runs]

    def close(self) -> None: ...


def test_the_exit_code_is_0_if_all_runs_ended_well(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(import_module("turtle_lesson.experiments.experiment"), "LocalPool", Well)
    (folder / "how_many.txt").write_text("1")
    assert main(["run", "robot/check.py", "--jobs", "1"]) == 0
    assert capsys.readouterr().out.endswith("2 runs, none failed\n")


@pytest.mark.parametrize(
    ("script", "options", "said"),
    [
        ("x = 1\n", [], "turtle-lesson run: it.py carries out no experiment\n"),
        ("1 / 0\n", [], 'File "it.py", line 1, in <module>\n    1 / 0\nZeroDivisionError: division by zero\n'),
        ("raise SystemExit('no robot')\n", [], "no robot\n"),
        (
            "from turtle_lesson.experiments import experiment\nexperiment(lambda lesson: None, gain=1)\n",
            [],
            "<lambda> cannot be called as <lambda>(lesson, gain=…): got an unexpected keyword argument 'gain'\n",
        ),
        ("x = 1\n", ["--csv", "a.txt"], 'a table is saved as "….csv" or "….parquet", got \'a.txt\'\n'),
        (None, [], "turtle-lesson run: there is no script it.py\n"),
    ],
)
def test_what_is_no_experiment_is_told_in_a_sentence(
    script: str | None, options: list[str], said: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if script is not None:
        Path("it.py").write_text(script)
    assert main(["run", "it.py", *options]) == 1
    captured = capsys.readouterr()
    assert captured.err.endswith(said) and captured.out == ""


def test_the_example_of_readme_runs_and_ends_as_it_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    readme = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
    code = readme.partition("<!-- experiment -->\n```python\n")[2].partition("```")[0]
    monkeypatch.chdir(tmp_path)
    space: dict[str, Any] = {"__name__": "__main__"}
    exec(compile(code.replace("seeds=range(50)", "seeds=[0, 1], jobs=1"), "readme.py", "exec"), space)
    assert [row["ok"] for row in space["results"].rate(by="latency")] == [2, 2, 1]
