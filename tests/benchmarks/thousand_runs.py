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
    before, load = time.monotonic(), os.getloadavg()[0]
    results: Results = experiment(drive, seeds=range(runs), progress=False, **options)
    took = time.monotonic() - before
    table = results.save(folder / f"{name}.csv").read_bytes()
    digest = hashlib.sha256(table).hexdigest()[:12]
    load = (load + os.getloadavg()[0]) / 2
    print(
        f"{name:22} {took:7.1f} s  {1000 * took / runs:6.1f} ms a run  table {digest}  {len(results.failed)} failed  "
        f"load {load:.1f}",
        flush=True,
    )
    return took


def kill_some(amount: int, every: float) -> threading.Thread:
    """Kill so many of this process's workers, one after the other, while they work."""

    def kill() -> None:
        for _ in range(amount):
            time.sleep(every)
            workers = [
                each for each in psutil.Process().children(recursive=True) if "spawn_main" in " ".join(each.cmdline())
            ]
            if workers:
                random.choice(workers).kill()

    thread = threading.Thread(target=kill, daemon=True)
    thread.start()
    return thread


def main() -> None:
    """Print a line for each way of carrying the runs out."""
    from distributed import Client, LocalCluster

    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        one = measured("one worker", runs, folder, jobs=1)
        two = measured("two workers", runs, folder, jobs=2)
        print(f"{'':22} {one / two:.2f} times as fast as one")
        options: dict[str, Any] = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": "127.0.0.1:0"}
        with LocalCluster(**options) as cluster, Client(cluster) as client:
            measured("Dask, two workers", runs, folder, client=client)
        killing = kill_some(3, two / 5)
        measured("two, three killed", runs, folder, jobs=2)
        killing.join()


if __name__ == "__main__":
    main()
