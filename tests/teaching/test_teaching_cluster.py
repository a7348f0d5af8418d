"""`turtle-lesson grade --client`: on a Dask cluster of two workers, as on this machine; and what can be wrong with one."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
import zipfile
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import nbformat
import pytest
import teaching_copies as copies

from turtle_lesson import __version__
from turtle_lesson.teaching import cluster
from turtle_lesson.teaching.main import main
from turtle_lesson.teaching.pages import PageError
from turtle_lesson.teaching.runner import Runner

PACKAGE = Path(cluster.__file__).resolve().parents[1]
KILLS_ITS_WORKER = "import psutil\npsutil.Process().parents()[1].kill()"
"""A kernel's parent is what runs the copy; the parent of that is the process of Dask's worker."""


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with an installed lesson of its own, since work on this one may go on meanwhile."""
    folder = tmp_path_factory.mktemp("cluster")
    shutil.copytree(PACKAGE, folder / "installed" / "turtle_lesson", ignore=shutil.ignore_patterns("__pycache__"))
    with (folder / "installed" / "turtle_lesson" / "lab" / "words.py").open("a") as file:
        file.write("# Another lesson than that of the checkout.\n")
    (folder / "tmp").mkdir()
    return folder


def environment(place: Path) -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(place / "installed"), "TMPDIR": str(place / "tmp")}


@pytest.fixture(scope="module")
def address(place: Path) -> Iterator[str]:
    """The address of a scheduler with two workers."""
    file = place / "scheduler.json"
    options = ["--no-dashboard", "--scheduler-file", str(file)]
    words = {
        "scheduler": ["--host", "127.0.0.1", "--port", "0"],
        "worker": [
            "--host",
            "127.0.0.1",
            "--nworkers",
            "2",
            "--nthreads",
            "1",
            "--local-directory",
            str(place / "dask"),
        ],
    }
    with (place / "cluster.log").open("w") as log:
        started = [
            subprocess.Popen(
                [sys.executable, "-m", f"distributed.cli.dask_{name}", *options, *more],
                cwd=place,
                env=environment(place),
                stdout=log,
                stderr=log,
            )
            for name, more in words.items()
        ]
    try:
        while not (file.exists() and file.read_text()):  # it is written a moment after it was made
            assert started[0].poll() is None, (place / "cluster.log").read_text()
            time.sleep(0.1)
        yield json.loads(file.read_text())["address"]
    finally:
        for process in reversed(started):
            process.terminate()
        for process in started:
            process.wait(60)


def grade(place: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "turtle_lesson", "grade", "--json", *words]
    return subprocess.run(command, cwd=place, env=environment(place), capture_output=True, text=True, timeout=400)


def test_a_cluster_grades_as_this_machine_does(place: Path, address: str) -> None:
    (place / "Ben_2_assignsubmission_file_.ipynb").write_text("this is no JSON")
    others = ["Ben_2_assignsubmission_file_.ipynb", "gone.ipynb"]
    for name, cell in (("Anna_1", copies.RIGHT), ("Dora_3", KILLS_ITS_WORKER)):
        with zipfile.ZipFile(place / f"{name}.zip", "w") as file:
            page = f"{name}_assignsubmission_file_/{copies.PAGE}.ipynb"
            file.writestr(page, nbformat.writes(copies.copy(cell, "1 / 0")))

    far = grade(place, "Anna_1.zip", *others, "Dora_3.zip", "--client", address)
    near = grade(place, "Anna_1.zip", *others, "--jobs", "2")

    *rest, dora = json.loads(far.stdout)["copies"]
    anna, *broken = rest
    assert rest == json.loads(near.stdout)["copies"]
    assert (anna["learner"], anna["earned"], anna["problem"]) == ("Anna", 3, "")
    assert anna["errors"] == ["cell 5 raised ZeroDivisionError: division by zero"]
    assert [each["problem"][:17] for each in broken] == ["is not a notebook", "cannot be read: N"]
    assert (dora["learner"], dora["earned"], dora["problem"]) == ("Dora", 0, cluster.DIED)
    assert far.returncode == near.returncode == 1
    for _ in range(100):  # what Dora's copy has left in the care of nobody
        left = list((place / "tmp").glob("turtle-lesson-*"))
        if not left:
            break
        time.sleep(0.2)
    assert left == []


def test_workers_with_another_lesson_are_refused(place: Path, address: str, capsys: pytest.CaptureFixture[str]) -> None:
    copies.write(place, "copy", copies.copy(copies.STUB, copies.STUB))
    assert main(["grade", str(place / "copy.ipynb"), "--client", address]) == 1
    said = capsys.readouterr().err
    assert f"version {__version__}, but tcp://127.0.0.1:" in said
    assert said.endswith("has other files of the same version\n") and said.count("\n") == 1


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (("9.9.9", "lesson"), "but tcp://a has version 9.9.9"),
        (
            ModuleNotFoundError("No module named 'turtle_lesson'"),
            "but tcp://a answers: No module named 'turtle_lesson'",
        ),
    ],
)
def test_what_a_worker_lacks_is_said(answer: Any, said: str) -> None:
    answers = {"tcp://a": answer, "tcp://b": (__version__, "lesson")}
    client = SimpleNamespace(wait_for_workers=lambda *_, **__: None, run=lambda *_, **__: answers)
    with pytest.raises(PageError, match=said):
        cluster._check_workers(client, "lesson")


def test_a_copy_is_never_run_by_another_lesson(monkeypatch: pytest.MonkeyPatch) -> None:
    """A worker that joins later is not looked at before, and one may change while copies are graded."""
    files = {"a.py": b"1"}
    monkeypatch.setattr("turtle_lesson.teaching.runner.installed", lambda: {"a.py": b"2"})
    monkeypatch.setattr(Runner, "run", lambda *_: pytest.fail("it was run"))
    seen = cluster.run_copy(b"", "name", 1, 1, cluster.fingerprint(files))
    assert seen.problem == "it was sent to a worker that has another version of the lesson"


@pytest.mark.parametrize(
    ("address", "said"),
    [
        ("tcp://127.0.0.1:9", "no scheduler of Dask answers at 'tcp://127.0.0.1:9'"),
        ("nonsense", "no scheduler of Dask answers at 'nonsense' (missing port"),
    ],
)
def test_a_cluster_that_is_not_there_is_said(
    address: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(cluster, "CONNECTING", 1)
    assert main(["grade", str(tmp_path / "copy.ipynb"), "--client", address]) == 1
    assert said in capsys.readouterr().err


def test_without_dask_it_is_said_how_to_install_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert main(["grade", str(tmp_path / "copy.ipynb"), "--client", "tcp://a:1"]) == 1
    assert "a cluster needs Dask, which is not here: pip install 'turtle-lesson[cluster]'" in capsys.readouterr().err
