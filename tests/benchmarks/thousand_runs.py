"""A thousand runs of the whole system, 30 s of robot time each: on one worker, on two, on Dask, and while workers are killed.

Run by: python tests/benchmarks/thousand_runs.py [RUNS]. The tables must be the same, byte for byte. The speed-up is told with
the machine's load, since whatever else runs takes its share of the cores.
"""

from __future__ import annotations

import hashlib
import os
import random
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import Any

import psutil

from turtle_lesson.experiments import experiment
from turtle_lesson.experiments.results import Results
from turtle_lesson.lab.words import count

SECONDS = 30.0


def drive(lesson: Any) -> dict[str, Any]:
    """Start the system, send the turtle to a goal that the seed draws, and look at where it has been after 30 s."""
    import rclpy
    from robot_controller.srv import NavigateTo

    lesson.launch("robot_controller", "start_system.launch.py")
    rclpy.init()
    node = rclpy.create_node("driver")
    client = node.create_client(NavigateTo, "/navigate_to")
    x, y = random.uniform(2, 9), random.uniform(2, 9)
    answer = client.call(NavigateTo.Request(x=x, y=y, theta=0.0))
    seconds = lesson.now
    lesson.run(SECONDS - lesson.now)
    poses = lesson._recording.place()
    return {
        "success": answer.success,
        "seconds": seconds,
        "x": poses[0],
        "y": poses[1],
        "events": lesson._world.sim.events,
    }


def measured(name: str, runs: int, folder: Path, **options: Any) -> float:
    """Carry the runs out; prints how long that took, and a hash of the table."""
    before, computed, load = time.monotonic(), cpu_time(), os.getloadavg()[0]
    results: Results = experiment(drive, seeds=range(runs), **options)
    took = time.monotonic() - before
    table = results.save(folder / f"{name}.csv").read_bytes()
    digest = hashlib.sha256(table).hexdigest()[:12]
    load, computed = (load + os.getloadavg()[0]) / 2, cpu_time() - computed
    print(
        f"{name:22} {took:7.1f} s  {1000 * computed / runs:6.1f} ms of CPU time a run  table {digest}  "
        f"{len(results.failed)} failed  load {load:.1f}",
        flush=True,
    )
    return took


def cpu_time() -> float:
    """The CPU time of this process and of its workers that have ended (s); not that of Dask's."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def kill_some(amount: int, every: float = 5.0) -> threading.Thread:
    """Kill so many of this process's workers, one every few seconds, while they work."""

    def kill() -> None:
        killed = 0
        while killed < amount:
            time.sleep(every)
            workers = [each for each in psutil.Process().children() if "spawn_main" in " ".join(each.cmdline())]
            if workers:
                random.choice(workers).kill()
                killed += 1
        print(f"{killed} workers were killed", flush=True)

    thread = threading.Thread(target=kill, daemon=True)
    thread.start()
    return thread


def main() -> None:
    """Print a line for each way of carrying the runs out."""
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        speed_up(folder, runs // 10)
        measured("two workers", runs, folder, jobs=2)
        measured("one worker", runs, folder, jobs=1)
        killing = kill_some(3)
        measured("two, three killed", runs, folder, jobs=2)
        killing.join()
        with_dask(folder, runs)


def speed_up(folder: Path, runs: int, rounds: int = 5) -> None:
    """Compare two workers and one in rounds that take turns. The fastest round of each had most of the machine."""
    times: dict[int, list[float]] = {1: [], 2: []}
    for _ in range(rounds):
        for jobs, taken in times.items():
            taken.append(measured(f"a round, {count(jobs, 'worker')}", runs, folder, jobs=jobs))
    ratios = sorted(one / two for one, two in zip(times[1], times[2], strict=True))
    best = min(times[1]) / min(times[2])
    print(
        f"two workers are {best:.2f} times as fast as one by the fastest rounds, {ratios[rounds // 2]:.2f} by the median one"
    )


def with_dask(folder: Path, runs: int) -> None:
    """The same on a cluster of two processes."""
    from distributed import Client, LocalCluster

    options: dict[str, Any] = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": "127.0.0.1:0"}
    with LocalCluster(**options) as cluster, Client(cluster) as client:
        measured("Dask, two workers", runs, folder, client=client)


if __name__ == "__main__":
    main()
