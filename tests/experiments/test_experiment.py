"""One function in many fresh worlds: the table that comes out, whatever workers carried the runs out."""

from __future__ import annotations

import contextlib
import os
import random
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest

import turtle_lesson
from turtle_lesson import start
from turtle_lesson.experiments import ExperimentError, Results, experiment, pools
from turtle_lesson.experiments.one_run import Run
from turtle_lesson.experiments.payload import setting_for
from turtle_lesson.learner.workspace import workspace

NEEDS_SIGNALS = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")
calls = 0


def drive(lesson: Any, kind: str, gain: float = 1.0) -> dict[str, Any] | None:
    """Ends in the way that `kind` says if the seed is 1, and else as it should."""
    global calls
    calls += 1
    seed = lesson._world.seed
    lesson.run(gain)
    Path("a_file_of_this_run.txt").open("x").close()
    if seed == 1 and kind == "raises":
        print("what it saw")
        raise ValueError("the turtle did not arrive\n(it never does)")
    if seed == 1 and kind == "exits":
        sys.exit("enough")
    if seed == 1 and kind == "long":
        lesson.run(1000)
    if seed == 1 and kind == "nested":
        experiment(drive, kind="well")
    if seed == 1 and kind == "list":
        return {"path": [1, 2]}
    if seed == 1 and kind == "own name":
        return {"outcome": "good"}
    chance = random.random(), float(np.random.random())
    return {
        "seconds": lesson.now,
        "calls": calls,
        "chance": chance[0],
        "numpys": np.float64(chance[1]),
        "even": seed % 2 == 0,
    }


KINDS = ["well", "raises", "exits", "long", "list", "nested", "own name"]


@pytest.fixture(scope="module")
def results() -> Results:
    return experiment(drive, seeds=[0, 1, 7], kind=KINDS, jobs=2, robot_time=50)


def test_there_is_a_row_for_each_combination_and_seed_in_their_order(results: Results) -> None:
    assert len(results) == 21 and results.missing == 0
    assert [row["run"] for row in results] == list(range(21))
    assert [row["seed"] for row in results] == [0, 1, 7] * 7
    assert [row["kind"] for row in results] == [kind for kind in KINDS for _ in range(3)]
    seeds = ["run", "seed", "kind", "outcome", "seconds", "calls", "chance", "numpys", "even"]
    assert results.columns == [*seeds, "robot_time", "error", "traceback", "printed"]
    np.testing.assert_equal(results.where(kind="raises")["seconds"], [1.0, np.nan, 1.0])
    assert list(results.where(kind="well")["even"]) == [True, False, False]


def test_a_run_that_fails_is_a_row_and_the_others_go_on(results: Results) -> None:
    outcomes = {kind: results.where(kind=kind, seed=1).rows[0]["outcome"] for kind in KINDS}
    assert outcomes == {
        "well": "ok",
        "raises": "raised",
        "exits": "raised",
        "long": "robot time",
        "list": "raised",
        "nested": "raised",
        "own name": "raised",
    }
    assert set(results.where(seed=0)["outcome"]) == set(results.where(seed=7)["outcome"]) == {"ok"}
    assert [row["run"] for row in results.failed] == [4, 7, 10, 13, 16, 19]
    assert repr(results).splitlines()[-1] == "21 runs, 6 failed: 4, 7, 10, 13, 16, 19"


def test_a_failed_row_says_where_and_what_was_printed_and_not_which_worker_it_was(results: Results) -> None:
    row = results.where(kind="raises", seed=1).rows[0]
    assert row["error"] == "ValueError: the turtle did not arrive"
    assert row["traceback"].endswith(
        ', in drive\n    raise ValueError("the turtle did not arrive\\n(it never does)")\n'
        "ValueError: the turtle did not arrive\n(it never does)\n"
    )
    assert row["printed"].endswith("what it saw\n")
    assert row["robot_time"] == 1.0
    long = results.where(kind="long", seed=1).rows[0]
    assert (long["robot_time"], long["error"]) == (
        50.0,
        "the run was not over when its world ended, at 50 s of robot time",
    )
    assert "lesson.run(1000)" in long["traceback"]
    wrong = results.where(kind="list", seed=1).rows[0]["error"]
    assert wrong.startswith("TypeError: drive must return a dict of numbers, texts") and wrong.endswith(
        "got 'path': [1, 2]"
    )
    named = results.where(kind="own name", seed=1).rows[0]
    said = "TypeError: drive returned 'outcome', a column that each table has already: give it another name"
    assert (named["error"], named["traceback"]) == (said, None)
    assert all(row["printed"] is None for row in results.ok)


def test_no_run_sees_what_another_one_left(results: Results) -> None:
    """Neither files, nor global variables, nor random numbers."""
    assert set(results.ok["calls"]) == {1.0}
    for seed in (0, 7):
        assert len(set(results.where(seed=seed)["chance"])) == len(set(results.where(seed=seed)["numpys"])) == 1


def test_the_table_is_the_same_for_one_worker_and_for_two(results: Results, tmp_path: Path) -> None:
    alone = experiment(drive, seeds=[0, 1, 7], kind=KINDS, jobs=1, robot_time=50)
    texts = [table.save(tmp_path / f"{name}.csv").read_bytes() for name, table in (("one", alone), ("two", results))]
    assert texts[0] == texts[1]


# -- what goes wrong -----------------------------------------------------------------------------------------------------


def dies(lesson: Any, folder: str) -> dict[str, Any]:
    """The worker of seed 4 always dies, those of some others the first time."""
    mark = Path(folder, str(lesson._world.seed))
    if not mark.exists() or lesson._world.seed == 4:
        mark.touch()
        os.kill(os.getpid(), getattr(signal, "SIGKILL", signal.SIGTERM))
    return {"seconds": lesson.now}


def test_three_workers_that_are_killed_lose_nothing_and_a_run_that_kills_its_own_is_a_row(tmp_path: Path) -> None:
    for seed in (0, 2, 5, 6):
        (tmp_path / str(seed)).touch()
    results = experiment(dies, seeds=range(7), folder=str(tmp_path), simulator=False, jobs=2)
    assert [row["outcome"] for row in results] == ["ok"] * 4 + ["worker died"] + ["ok"] * 2
    assert results.failed.rows[0]["error"] == "the worker process died, twice, in the middle of this run"


def test_a_process_that_has_died_between_two_runs_is_replaced() -> None:
    run = Run(0, 0, {"kind": "well"})
    worker = pools.Worker(setting_for(drive, simulator=False))
    try:
        first = worker.carry_out(run)
        assert worker._pid is not None
        process = psutil.Process(worker._pid.result())
        process.kill()
        with contextlib.suppress(psutil.Error):
            process.wait()
        assert worker.carry_out(run) == first and first.outcome == "ok"
    finally:
        worker.close()


def takes_long(lesson: Any) -> None:
    if lesson._world.seed == 0:
        while True:
            pass
    if lesson._world.seed == 1:
        mine, its = socket.socketpair()
        mine.recv(1)
        its.close()


@NEEDS_SIGNALS
def test_a_run_that_computes_or_waits_for_ever_is_a_row_that_says_where(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pools, "WINDOW", 0.3)
    monkeypatch.setattr(pools, "WAITS", 1.0)
    results = experiment(takes_long, seeds=range(3), cpu_time=0.3, jobs=1, simulator=False)
    assert list(results["outcome"]) == ["CPU time", "CPU time", "ok"]
    assert results.rows[0]["error"] == "the run took more than 0.3 s of CPU time"
    assert re.search(r", in takes_long\n    (while True:|pass)\n$", results.rows[0]["traceback"])
    assert results.rows[1]["error"] == "the run waited for something outside its world for 1 s"
    assert results.rows[1]["traceback"].endswith(", in takes_long\n    mine.recv(1)\n")


def interrupts(lesson: Any) -> dict[str, int]:
    if lesson._world.seed == 1:
        os.kill(os.getppid(), signal.SIGINT)
        threading.Event().wait()
    return {"seed": 1} if lesson._world.seed == 5 else {}


@NEEDS_SIGNALS
def test_after_ctrl_c_the_rows_that_are_there_are_kept(capsys: pytest.CaptureFixture[str]) -> None:
    before = {child.pid for child in psutil.Process().children()}
    results = experiment(interrupts, seeds=range(3), jobs=1, simulator=False)
    assert [row["seed"] for row in results] == [0]
    assert results.missing == 2
    assert repr(results).endswith("1 run, none failed; 2 not carried out")
    assert capsys.readouterr().out.startswith("Stopped: 1 of 3 runs were over.")
    left = {child.pid: child.cmdline() for child in psutil.Process().children() if child.pid not in before}
    assert not [words for words in left.values() if "spawn_main" in " ".join(words)]


lock = threading.Lock()


def holds_a_lock(lesson: Any) -> None:
    lock.acquire()


def takes_no_lesson() -> None: ...


def takes_all(lesson: Any, **options: Any) -> None: ...


@pytest.mark.parametrize(
    ("function", "options", "said"),
    [
        (drive, {"kind": 1, "kidn": 1}, "drive cannot be called as drive(lesson, kind=…, kidn=…): got an unexpected keyword"),
        (drive, {}, "drive cannot be called as drive(lesson): missing a required argument: 'kind'"),
        (drive, {"kind": []}, "kind must be one or more numbers, texts, True, False, None or tuples of these, got []: try k"),
        (drive, {"kind": [object]}, "kind must be one or more numbers, texts, True, False, None or tuples of these, got [<cla"),
        (drive, {"kind": "a", "seeds": []}, "seeds must be one or more whole numbers, got []: try seeds=range(10)"),
        (drive, {"kind": "a", "seeds": 5}, "seeds must be one or more whole numbers, got 5: try seeds=range(10)"),
        (drive, {"kind": "a", "seeds": [True]}, "seeds must be one or more whole numbers, got [True]"),
        (drive, {"kind": "a", "jobs": 0}, "jobs must be a whole number from 1 to 512, got 0"),
        (drive, {"kind": "a", "cpu_time": -1}, "cpu_time must be a number of seconds above 0, got -1"),
        (drive, {"kind": "a", "start_order": "any"}, "start_order must be \"as written\" or \"shuffled\", got 'any'"),
        (drive, {"kind": "a", "distro": "old"}, 'distro must be one of the releases "humble", "iron"'),
        (drive, {"kind": "a", "package": "nowhere"}, 'package must be "finished", "mine", None or the folder of a package'),
        (takes_no_lesson, {}, "takes_no_lesson cannot be called as takes_no_lesson(lesson): too many positional arguments"),
        (takes_all, {"run": 1}, "takes_all has a parameter 'run', as each table has: give it another name"),
        (holds_a_lock, {}, "holds_a_lock cannot be sent to a worker process: it uses lock"),
        (3, {}, "an experiment needs a function such as `def drive(lesson): …`, got 3"),
    ],
)  # fmt: skip
def test_what_cannot_be_carried_out_gets_one_sentence(function: Any, options: dict[str, Any], said: str) -> None:
    with pytest.raises(ExperimentError) as refused:
        experiment(function, **options)
    assert str(refused.value).startswith(said)


def test_a_function_that_uses_the_notebooks_own_lesson_is_refused() -> None:
    mine = start(simulator=False)

    def uses_it(lesson: Any) -> None:
        mine.run(1)

    with pytest.raises(
        ExperimentError, match="uses_it cannot be sent to a worker process: it uses mine, a Lesson that"
    ):
        experiment(uses_it)


def test_a_simulated_program_carries_out_no_experiment_and_no_run_one_of_its_own(results: Results) -> None:
    world = start(simulator=False)._world
    process = world.spawn(lambda: experiment(drive, kind=1), name="program")
    world.sim.settle()
    assert str(process.error).startswith("a simulated program cannot carry out an experiment")
    said = results.where(kind="nested", seed=1).rows[0]["error"]
    assert said == "ExperimentError: a run of an experiment cannot carry out an experiment of its own"


# -- where runs are ------------------------------------------------------------------------------------------------------


def test_a_program_is_not_run_again_by_its_workers_and_needs_no_guard(tmp_path: Path) -> None:
    (tmp_path / "helpers.py").write_text("import time\n\ndef double(gain):\n    time.sleep(0)\n    return 2 * gain\n")
    (tmp_path / "program.py").write_text(
        "from helpers import double\nfrom turtle_lesson.experiments import experiment\n"
        "print('this program runs')\n"
        "def drive(lesson, gain):\n    return {'doubled': double(gain)}\n"
        "print(experiment(drive, seeds=range(2), gain=[3, 4], simulator=False, jobs=1)['doubled'].tolist())\n"
    )
    environment = dict(os.environ) | {"PYTHONPATH": str(Path(turtle_lesson.__file__).parents[1])}
    said = subprocess.check_output([sys.executable, "program.py"], text=True, cwd=tmp_path, env=environment)
    assert said == "this program runs\n[6, 6, 8, 8]\n"


def looks_around(lesson: Any) -> dict[str, Any]:
    began = time.monotonic()
    lesson.launch("robot_controller", "start_system.launch.py")
    Path("workspace", "src", "mine.txt").write_text("changed")
    built = Path("workspace", "install", "setup.bash").stat().st_mtime_ns
    return {
        "built": str(built),
        "state": lesson.workspace.state(),
        "took": time.monotonic() > began,
        "here": Path.cwd().name,
    }


def test_a_run_has_a_copy_of_the_learners_workspace_which_is_built_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    start(page="06_parameters_and_launch")
    workspace().prepare("07_command_line")
    lines = sorted((path.name, path.stat().st_mtime_ns) for path in tmp_path.rglob("*"))
    results = experiment(looks_around, seeds=range(3), package="mine", jobs=1)
    assert not results.failed, results.failed.rows
    assert len(set(results["built"])) == 1
    assert "navigator_node.py" in results.rows[0]["state"]
    assert sorted((path.name, path.stat().st_mtime_ns) for path in tmp_path.rglob("*")) == lines


def test_the_cores_of_a_hub_or_a_container_count(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda pid: set(range(8)), raising=False)
    monkeypatch.setenv("CPU_LIMIT", "1.5")
    assert pools.cores() <= 2
    monkeypatch.setenv("CPU_LIMIT", "nonsense")
    assert 1 <= pools.cores() <= 8
