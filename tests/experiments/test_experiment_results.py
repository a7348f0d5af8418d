"""The table of an experiment: what is shown of it, files, going on with it, and what the runs have in common."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import pytest

from turtle_lesson.experiments import ExperimentError, Results, experiment
from turtle_lesson.experiments.one_run import Ending, Run
from turtle_lesson.experiments.results import wilson
from turtle_lesson.experiments.table import read

VALUES = [
    {"seconds": 1.5, "name": 'a, "b"\n# c', "hits": 3, "fast": True, "mixed": 1, "empty": "", "odd": "a\rb", "far": 1},
    {
        "seconds": float("nan"),
        "name": None,
        "hits": -2,
        "fast": False,
        "mixed": "1",
        "empty": "x",
        "odd": None,
        "far": float("inf"),
    },
    {"seconds": 1e300, "name": "ü", "hits": 2**70, "fast": None, "mixed": 2.0, "empty": None, "odd": "", "late": None},
]


def table(amount: int = 3) -> Results:
    """Some runs of which every fourth has failed."""
    endings = []
    for number in range(amount):
        run = Run(number, number % 50, {"gain": [1.0, 2.0][number % 2], "goal": (1, 2.5), "order": "shuffled"})
        good = Ending("ok", {"seconds": float(number)} if amount > 3 else VALUES[number], 1.0)
        bad = Ending("raised", {}, 0.5, "ValueError: no", "Traceback …\n", "it printed\n")
        endings.append((run, bad if number % 4 == 3 else good))
    swept = ["order", "gain", "goal"]
    about = {"world": {"package": None, "distro": "jazzy"}, "turtle_lesson": "1.0"}
    return Results(reversed(endings), swept, about=about, missing=2)


def test_columns_are_arrays_in_which_nothing_is_nan() -> None:
    results = table(8)
    np.testing.assert_equal(results["seconds"], [0, 1, 2, np.nan, 4, 5, 6, np.nan])
    assert results["run"].dtype == int
    assert table()["fast"].tolist()[:2] == [1.0, 0.0]
    assert results["goal"].tolist() == [(1, 2.5)] * 8
    assert results["error"].tolist() == [None, None, None, "ValueError: no"] * 2
    assert (results["outcome"] == "ok").sum() == len(results.ok) == 6
    with pytest.raises(ExperimentError, match="there is no column 'secnds'"):
        results["secnds"]
    frame = pandas.DataFrame(results.rows)
    assert frame.groupby("gain").seconds.max().tolist() == [6.0, 5.0]


def test_a_long_table_is_shown_in_part_with_a_sentence_below() -> None:
    results = table(100)
    lines = repr(results).splitlines()
    assert lines[0].split() == [
        "run",
        "seed",
        "order",
        "gain",
        "goal",
        "outcome",
        "seconds",
        "robot_time",
        "error",
    ]
    assert lines[4].split() == ["3", "3", "shuffled", "2", "(1,", "2.5)", "raised", "0.5", "ValueError:", "no"]
    assert len({len(line) for line in lines if "raised" in line}) == 1
    assert lines[21] == "…"
    assert lines[22].startswith("100 runs, 25 failed: 3, 7, 11,") and lines[22].endswith("13 more; 2 not carried out")
    shown = results._repr_html_()
    assert shown.count("<tr>") == 22 and shown.endswith(f"<p>{lines[22]}</p>")
    assert repr(results.ok).splitlines()[0].split()[-1] == "robot_time"
    assert "a, &quot;b&quot; # c" in table()._repr_html_()


def test_other_programs_read_the_files(tmp_path: Path) -> None:
    results = table(8)
    frame = pandas.read_csv(results.save(tmp_path / "runs.csv"), comment="#")
    np.testing.assert_equal(frame["seconds"].to_numpy(), results["seconds"])
    assert frame["goal"].tolist() == ["[1, 2.5]"] * 8
    parquet = pandas.read_parquet(results.save(tmp_path / "runs.parquet"))
    np.testing.assert_equal(parquet["seconds"].to_numpy(), results["seconds"])
    head = (tmp_path / "runs.csv").read_text().splitlines()[:4]
    assert head == [
        '# world: {"package": null, "distro": "jazzy"}',
        '# turtle_lesson: "1.0"',
        '# swept: ["order", "gain", "goal"]',
        "# missing: 2",
    ]
    with pytest.raises(ExperimentError, match=r"saved as \"….csv\" or \"….parquet\", got 'runs.txt'"):
        table().save("runs.txt")


@pytest.mark.parametrize("kind", ["csv", "parquet"])
def test_a_file_gives_back_every_value_as_it_was(kind: str, tmp_path: Path) -> None:
    results = table()
    found, head = read(results.save(tmp_path / f"runs.{kind}"))
    assert repr(found.rows) == repr(results.rows)
    assert [[type(value) for value in row.values()] for row in found] == [
        [type(value) for value in row.values()] for row in results
    ]
    assert (found.columns, head) == (results.columns, results.about | {"swept": results.swept, "missing": 2})


def test_what_is_no_table_is_refused(tmp_path: Path) -> None:
    damaged = '# columns: {"a": "int"}\na\n1 +\n'
    shouted = '# columns: {"a": "bool"}\na\nTRUE\n'  # as spreadsheets write it
    files = {"a.csv": "run,seed\n1,2\n", "b.csv": "", "c.parquet": "x", "d.csv": damaged, "e.csv": shouted}
    for name, text in files.items():
        (tmp_path / name).write_text(text)
        with pytest.raises(ExperimentError, match=name):
            read(tmp_path / name)


# -- going on ------------------------------------------------------------------------------------------------------------


class Counted:
    """Stands for the worker processes: what is carried out is only noted."""

    def __init__(self) -> None:
        self.runs: list[Run] = []
        self.jobs = 0

    def pool(self, setting: Any, jobs: int) -> Counted:
        self.jobs = jobs
        return self

    def carry_out(self, runs: list[Run]) -> Any:
        self.runs = list(runs)
        for run in runs[::-1]:
            died = run.number == 1 and len(runs) > 2
            yield run, Ending("worker died") if died else Ending("ok", {"twice": 2 * run.parameters["gain"]}, 1.0)

    def close(self) -> None: ...


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Counted:
    counted = Counted()
    module = import_module("turtle_lesson.experiments.experiment")  # the package's attribute is the function
    monkeypatch.setattr(module, "LocalPool", counted.pool)
    monkeypatch.chdir(tmp_path)
    return counted


FACTOR = 1.0


def drive(lesson: Any, gain: float, loss: float = 0.0) -> float:
    return FACTOR * gain


def test_a_saved_experiment_goes_on_with_what_is_new_and_what_its_workers_died_of(counted: Counted) -> None:
    experiment(drive, seeds=range(2), gain=[1.0, 2.0]).save("runs.csv")
    assert len(counted.runs) == 4
    results = experiment(drive, seeds=range(3), gain=[1.0, 2.0], resume="runs.csv", jobs=8)
    assert counted.jobs == 3, "no more workers than runs"
    assert [(run.seed, run.parameters["gain"]) for run in counted.runs] == [(1, 1.0), (2, 1.0), (2, 2.0)]
    assert [row["run"] for row in results] == list(range(6)) and results.rows[3]["twice"] == 4.0
    results.save("more.parquet")
    whole = experiment(drive, seeds=range(3), gain=[1.0, 2.0], resume="more.parquet")
    assert [run.number for run in counted.runs] == [1] and len(whole.ok) == 6
    again = experiment(drive, seeds=range(3), gain=[1.0, 2.0], resume=whole.save("whole.csv"))
    assert [run.number for run in counted.runs] == [1] and again.rows == whole.rows, "all is known"


def test_a_table_of_another_experiment_is_not_gone_on_with(counted: Counted, monkeypatch: pytest.MonkeyPatch) -> None:
    experiment(drive, gain=1.0).save("runs.csv")
    before = counted.runs
    for options, said in (
        ({"loss": [0.1]}, "its swept is ['gain'], and that of this experiment ['gain', 'loss']"),
        ({"robot_time": 10}, "its robot_time is 600.0, and that of this experiment 10.0"),
        ({"package": None}, "its world is"),
    ):
        with pytest.raises(ExperimentError, match=re.escape(f"runs.csv cannot be resumed: {said}")):
            experiment(drive, gain=1.0, resume="runs.csv", **options)
    monkeypatch.setattr("test_experiment_results.FACTOR", 2.0)
    with pytest.raises(ExperimentError, match="its function is 'drive"):
        experiment(drive, gain=1.0, resume="runs.csv")
    with pytest.raises(ExperimentError, match=r"there is no file no\.csv"):
        experiment(drive, gain=1.0, resume="no.csv")
    assert counted.runs is before


# -- statistics ----------------------------------------------------------------------------------------------------------


def test_the_rate_comes_with_wilsons_interval() -> None:
    rows = table(8).rate(by="gain").rows
    assert rows[0] == {
        "gain": 1.0,
        "runs": 4,
        "ok": 4,
        "rate": 1.0,
        "low": pytest.approx(0.5101, abs=1e-4),
        "high": 1.0,
    }
    assert rows[1] | {"low": 0, "high": 0} == {"gain": 2.0, "runs": 4, "ok": 2, "rate": 0.5, "low": 0, "high": 0}
    assert wilson(81, 263) == pytest.approx((0.2553, 0.3662), abs=1e-4)  # Newcombe 1998, table I
    assert wilson(15, 148) == pytest.approx((0.0624, 0.1605), abs=1e-4)
    assert wilson(0, 20) == pytest.approx((0.0, 0.1611), abs=1e-4)


def test_quantiles_leave_out_what_has_no_value() -> None:
    rows = table(8).quantiles("seconds", at=[0, 0.5, 1]).rows
    assert rows == [{"runs": 6, "0 %": 0.0, "50 %": 3.0, "100 %": 6.0}]
    assert table(8).quantiles("seconds", by="outcome").rows[1] == {
        "outcome": "raised", "runs": 0, "5 %": None, "25 %": None, "50 %": None, "75 %": None, "95 %": None,
    }  # fmt: skip
    for arguments in (["seconds", None, [2]], ["error"], ["seconds", "nothing"]):
        with pytest.raises(ValueError):
            table(8).quantiles(*arguments)


def test_a_picture_says_what_it_shows() -> None:
    picture = table(8).plot("seconds", by="gain")
    assert picture.text == (
        "seconds of 6 runs by gain. gain 1: 4 runs, median 3, half of them from 1.5 to 4.5, all from 0 to 6. "
        "gain 2: 4 runs, 2 without a value, median 3, half of them from 2 to 4, all from 1 to 5."
    )
    assert picture.figure is not None and picture.png() == table(8).plot("seconds", by="gain").png()
    assert table(8).plot("seconds").text.startswith("seconds of 6 runs. seconds: 8 runs, 2 without a value, median 3,")
    nothing = table(8).failed.plot("seconds")
    assert (nothing.text, nothing.figure) == ("There is no seconds to draw: 2 runs, 2 failed: 3, 7.", None)
