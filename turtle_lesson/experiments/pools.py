"""Worker processes: each carries out one run at a time, and one that dies takes no other run with it."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import shutil
import signal
import sys
import tempfile
import threading
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from types import ModuleType

from . import one_run
from .one_run import DIED, Ending, Run, Setting

LOOK = 0.25
"""How often, in seconds, running workers are looked at."""


class Worker:
    """A worker process of this computer, and the next one where it has died."""

    def __init__(self, setting: Setting) -> None:
        self._setting = setting
        self._pool: ProcessPoolExecutor | None = None
        self._folder: Path | None = None
        self._pid: Future[int] | None = None

    def submit(self, run: Run) -> Future[Ending]:
        """Have it carry out a run. BrokenProcessPool is raised by the future if the process dies."""
        with _alone():
            if self._pool is None:
                self._folder = Path(tempfile.mkdtemp(prefix="turtle-lesson-"))
                spawn = multiprocessing.get_context(
                    "spawn"
                )  # to fork a kernel, which is full of threads, would be unsafe
                self._pool = ProcessPoolExecutor(1, spawn, one_run.begin, (self._setting, self._folder))
                self._pid = self._pool.submit(os.getpid)
            return self._pool.submit(one_run.carry_out, run)

    def close(self) -> None:
        """End the process, whatever it does."""
        pool, self._pool = self._pool, None
        if pool is None:
            return
        pool.shutdown(wait=False, cancel_futures=True)
        self.kill()
        pool.shutdown()
        if self._folder is not None:
            shutil.rmtree(self._folder, ignore_errors=True)

    def kill(self) -> None:
        """Kill the process, if it has begun."""
        with contextlib.suppress(Exception):
            if self._pid is not None:
                os.kill(self._pid.result(timeout=30), getattr(signal, "SIGKILL", signal.SIGTERM))


_starting = threading.Lock()


@contextlib.contextmanager
def _alone() -> Iterator[None]:
    """Within this block a process that begins does not import the caller's program as its own `__main__`.

    So a program needs no `if __name__ == "__main__"`, and a notebook's kernel is none to be started again.
    All workers also order the elements of sets alike.
    """
    with _starting:
        main, hashes = sys.modules["__main__"], os.environ.get("PYTHONHASHSEED")
        sys.modules["__main__"] = ModuleType("__main__")
        os.environ["PYTHONHASHSEED"] = "0"
        try:
            yield
        finally:
            sys.modules["__main__"] = main
            if hashes is None:
                del os.environ["PYTHONHASHSEED"]
            else:
                os.environ["PYTHONHASHSEED"] = hashes


def carry_out_here(setting: Setting, runs: Sequence[Run], jobs: int) -> Iterator[tuple[Run, Ending]]:
    """Carry out runs on worker processes of this computer, as they end. A run whose worker died is tried once more, alone."""
    died: list[Run] = []
    for run, ending in _carry_out(setting, runs, jobs):
        if ending.outcome == DIED:
            died.append(run)
        else:
            yield run, ending
    yield from _carry_out(setting, died, 1)


def _carry_out(setting: Setting, runs: Sequence[Run], jobs: int) -> Iterator[tuple[Run, Ending]]:
    waiting = deque(runs)
    idle = [Worker(setting) for _ in range(min(jobs, len(runs)))]
    workers = list(idle)
    busy: dict[Future[Ending], tuple[Worker, Run]] = {}
    try:
        while waiting or busy:
            while waiting and idle:
                worker, run = idle.pop(), waiting.popleft()
                busy[worker.submit(run)] = worker, run
            for future in wait(busy, timeout=LOOK, return_when=FIRST_COMPLETED).done:
                worker, run = busy.pop(future)
                idle.append(worker)
                yield run, _ending(worker, future)
    finally:
        for worker in workers:
            worker.close()


def _ending(worker: Worker, future: Future[Ending]) -> Ending:
    try:
        return future.result()
    except BrokenProcessPool:
        worker.close()
        return Ending(DIED, error="the worker process ended in the middle of this run")


def cores() -> int:
    """How many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
