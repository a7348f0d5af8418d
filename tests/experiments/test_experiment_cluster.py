"""Experiments on a cluster of dask.distributed: the same table as here, also where workers die."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest
from distributed import Client, LocalCluster

from turtle_lesson.experiments import ExperimentError, experiment


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    options: dict[str, Any] = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": "127.0.0.1:0"}
    with LocalCluster(**options) as cluster, Client(cluster) as client:
        yield client


def drive(lesson: Any, kind: str) -> dict[str, Any]:
    lesson.run(2)
    seed = lesson._world.seed
    if seed == 1 and kind == "raises":
        raise ValueError(f"no, in {Path.cwd()}")
    if seed == 1 and kind == "dies":
        os._exit(3)
    return {"seconds": lesson.now}


def processes_of(client: Client) -> set[int]:
    """The workers of the cluster, and what they have started."""
    return {each.pid for pid in client.run(os.getpid).values() for each in psutil.Process(pid).children(recursive=True)}


def test_the_table_is_the_same_byte_for_byte_as_on_this_computer(client: Client, tmp_path: Path) -> None:
    options: dict[str, Any] = {"seeds": [1], "kind": ["well", "raises", "dies"], "simulator": False}
    before = processes_of(client)
    there = experiment(drive, client=client, **options)
    here = experiment(drive, jobs=1, **options)
    assert there.save(tmp_path / "there.csv").read_bytes() == here.save(tmp_path / "here.csv").read_bytes()
    assert [row["outcome"] for row in there.failed] == ["raised", "worker died"]
    assert there.failed.rows[0]["error"] == "ValueError: no, in ."
    assert processes_of(client) <= before, "its processes have ended"


def waits_for_a_file(lesson: Any, folder: str) -> dict[str, Any]:
    Path(folder, f"{os.getppid()}").touch()
    while not Path(folder, "go").exists():
        time.sleep(0.01)
    return {"seed": lesson._world.seed} if lesson._world.seed < 0 else {"seconds": lesson.now}


def test_nothing_is_lost_when_a_worker_of_the_cluster_dies(client: Client, tmp_path: Path) -> None:
    """One that carries out a run is killed; Dask has another one do so."""

    def kill() -> None:
        while not (begun := list(tmp_path.iterdir())):
            time.sleep(0.05)
        psutil.Process(int(begun[0].name)).kill()
        (tmp_path / "go").touch()

    killing = threading.Thread(target=kill)
    killing.start()
    results = experiment(waits_for_a_file, seeds=range(4), folder=str(tmp_path), client=client, simulator=False)
    killing.join()
    assert len(results) == 4 and not results.failed


def test_a_cluster_that_is_not_there_is_told_in_one_sentence(client: Client) -> None:
    closed = Client(client.scheduler.address, set_as_default=False)
    closed.close()
    for wrong, said in (
        ("tcp://127.0.0.1:1", "no scheduler of Dask answers at 'tcp://127.0.0.1:1' "),
        ("127.0.0.1", "no scheduler of Dask answers at '127.0.0.1' (missing port number"),
        ("nothing://here:80", "no scheduler of Dask answers at 'nothing://here:80' (unknown address scheme"),
        (5, "no scheduler of Dask answers at 5 "),
        (closed, "this client is closed or asynchronous: make a new Client(…), got <Client"),
    ):
        with pytest.raises(ExperimentError) as refused:
            experiment(drive, kind="well", client=wrong)
        assert str(refused.value).startswith(said)
