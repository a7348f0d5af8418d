"""Worker processes, here or on a cluster: each carries out one run at a time, and one that dies takes no other run with it.

Each worker is a `ProcessPoolExecutor` of one process. So it is known which run a process died of, and one that computes for
too long can be killed. On a cluster each of Dask's workers has such processes, too: a world needs the main thread and a
current folder, and Dask's tasks are threads. If one of Dask's workers dies, Dask has its runs carried out by another one.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import platform
import re
import shutil
import signal
import socket
import sys
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor, as_completed, wait
from concurrent.futures.process import BrokenProcessPool
from linecache import getline
from math import ceil
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeVar

import psutil

from ..ros.sim.defer_sigint import defer_sigint
from ..ros.sim.errors import is_learners, shown_path
from . import one_run
from .one_run import CPU_TIME, DIED, STACK, VERSION, Ending, ExperimentError, Run, Setting

if TYPE_CHECKING:
    from distributed import Client

T = TypeVar("T")

LOOK = 0.25
"""How often, in seconds of real time, busy workers are looked at."""

WINDOW, WAITING = 5.0, 0.02
"""A process that computes for less than this share of so many seconds of real time waits for something."""

WAITS = 60.0
"""How long, in seconds of real time, a run may wait for something outside, if its CPU time is no longer limit."""

_KILL = getattr(signal, "SIGKILL", signal.SIGTERM)


class Worker:
    """A worker process, and the next one where it has died or was killed."""

    def __init__(self, setting: Setting) -> None:
        self._setting = setting
        self._pool: ProcessPoolExecutor | None = None
        self._pid: Future[int] | None = None
        self._folder = Path()
        self.ended = False
        """Set by another thread: the run that goes on is to be ended, and no other one begun."""

    def carry_out(self, run: Run) -> Ending:
        """Carry out a run, and wait for its end; if the process dies, it is tried once more."""
        for _ in range(2):
            future = self._submit(run)
            watch: _Watch | None = None
            verdict: Ending | None = None
            while not self.ended and not wait([future], LOOK).done:
                if self._pid is None or not self._pid.done() or self._pid.exception() is not None:
                    continue
                with contextlib.suppress(psutil.Error, ProcessLookupError):  # it has ended a moment ago
                    watch = watch or _Watch(self._pid.result(), self._setting.cpu_time)
                    if verdict is None and (too_long := watch.too_long()):
                        verdict = Ending(CPU_TIME, error=too_long, traceback=self._where())
                        os.kill(self._pid.result(), _KILL)
            if self.ended:
                self.close()
                break
            try:
                return future.result()
            except BrokenProcessPool:
                self._clear()
                if verdict is not None:
                    return verdict
        return Ending(DIED, error="the worker process died, twice, in the middle of this run")

    def _submit(self, run: Run) -> Future[Ending]:
        with _starting(), defer_sigint():
            if self._pool is not None:
                with contextlib.suppress(BrokenProcessPool):  # it has died since its last run
                    return self._pool.submit(one_run.carry_out, run)
                self._clear()
            self._folder = Path(tempfile.mkdtemp(prefix="turtle-lesson-"))
            spawn = multiprocessing.get_context("spawn")  # a kernel is full of threads: no fork of it would be safe
            self._pool = ProcessPoolExecutor(1, spawn, one_run.begin, (self._setting, self._folder))
            self._pid = self._pool.submit(os.getpid)
            return self._pool.submit(one_run.carry_out, run)

    def close(self) -> None:
        """End the process, whatever it does."""
        with defer_sigint():
            if self._pool is not None and self._pid is not None:
                with contextlib.suppress(Exception):  # it has ended by itself
                    os.kill(self._pid.result(timeout=60), _KILL)
            self._clear()

    def _clear(self) -> None:
        pool, self._pool = self._pool, None
        if pool is not None:
            pool.shutdown(cancel_futures=True)
            shutil.rmtree(self._folder, ignore_errors=True)

    def _where(self) -> str:
        """Where its main thread is, as the end of a traceback; "" where the system cannot tell."""
        assert self._pid is not None
        file = self._folder / STACK
        if not hasattr(signal, "SIGUSR1") or not file.exists():
            return ""
        os.kill(self._pid.result(), signal.SIGUSR1)
        time.sleep(LOOK)
        said = file.read_text(errors="replace").replace(str(self._folder / "run"), ".")
        frames = re.findall(r'File "(.+)", line (\d+) in (.+)', said)
        lines = []
        for name, line, function in reversed([frame for frame in frames if is_learners(frame[0])]):
            code = getline(name, int(line)).strip()
            lines.append(
                f'  File "{shown_path(name)}", line {line}, in {function}\n' + (f"    {code}\n" if code else "")
            )
        return "".join(["Where it was:\n", *lines]) if lines else ""


class _Watch:
    """The CPU time and the waiting of one run, seen from outside."""

    def __init__(self, pid: int, limit: float) -> None:
        self._process, self._limit = psutil.Process(pid), limit
        self._began = self._mark = self._computed()
        self._worked = time.monotonic()

    def _computed(self) -> float:
        times = self._process.cpu_times()
        return times.user + times.system

    def too_long(self) -> str:
        """What it has done for too long, in words; "" if it goes on."""
        now, computed = time.monotonic(), self._computed()
        if computed - self._mark >= WAITING * max(now - self._worked, WINDOW):
            self._worked, self._mark = now, computed
        if computed - self._began > self._limit:
            return f"the run took more than {self._limit:g} s of CPU time"
        if now - self._worked > max(self._limit, WAITS):
            return f"the run waited for something outside its world for {max(self._limit, WAITS):g} s"
        return ""


_start = threading.Lock()


@contextlib.contextmanager
def _starting() -> Iterator[None]:
    """Within this block, processes begin without importing the caller's program, and with one order of elements in sets.

    The caller's `__main__` is what multiprocessing would import: a program without `if __name__ == "__main__"` would run once
    more in each worker. And a worker of Dask's is a daemon, which must have no children otherwise; these end by themselves.
    """
    settings: dict[str, Any] = multiprocessing.current_process()._config  # type: ignore[attr-defined]
    with _start:
        main, hashes, daemon = sys.modules["__main__"], os.environ.get("PYTHONHASHSEED"), settings.get("daemon")
        sys.modules["__main__"] = ModuleType("__main__")
        os.environ["PYTHONHASHSEED"], settings["daemon"] = "0", False
        try:
            yield
        finally:
            sys.modules["__main__"], settings["daemon"] = main, daemon
            if hashes is None:
                del os.environ["PYTHONHASHSEED"]
            else:
                os.environ["PYTHONHASHSEED"] = hashes


class Workers:
    """Worker processes of one experiment, one for each thread that has a run carried out; each waits for further runs."""

    def __init__(self, setting: Setting) -> None:
        self._setting = setting
        self._all: list[Worker] = []
        self._idle: deque[Worker] = deque()

    def carry_out(self, run: Run) -> Ending:
        """Carry out a run, in this thread."""
        try:
            worker = self._idle.popleft()
        except IndexError:
            worker = Worker(self._setting)
            self._all.append(worker)
        try:
            return worker.carry_out(run)
        finally:
            self._idle.append(worker)

    def close(self) -> None:
        """End all processes: idle ones now, the others soon, by the threads that wait for them."""
        for worker in self._all:
            worker.ended = True
        for worker in list(self._idle):
            worker.close()


class LocalPool:
    """Carries out so many runs at once on this computer."""

    def __init__(self, setting: Setting, jobs: int) -> None:
        self._workers, self._threads = Workers(setting), ThreadPoolExecutor(jobs)

    def carry_out(self, runs: Sequence[Run]) -> Iterator[tuple[Run, Ending]]:
        """Carry out runs; they come in the order in which they end."""
        of = {self._threads.submit(self._workers.carry_out, run): run for run in runs}
        for future in as_completed(of):
            yield of[future], future.result()

    def close(self) -> None:
        """End it all, whatever goes on."""
        self._workers.close()
        self._threads.shutdown(cancel_futures=True)


def cores() -> int:
    """How many cores this process may use: those that the system, a container or a hub gives it."""
    limits = [len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1]
    with contextlib.suppress(KeyError, ValueError):
        limits.append(ceil(float(os.environ["CPU_LIMIT"])))  # JupyterHub's
    with contextlib.suppress(OSError, ValueError):
        quota, period = Path("/sys/fs/cgroup/cpu.max").read_text().split()
        limits.append(ceil(int(quota) / int(period)))  # it may be "max"
    return max(1, min(limits))


# -- on a cluster of dask.distributed -------------------------------------------------------------------------------------

PATIENCE = 10.0
"""Seconds of real time within which a scheduler answers."""

FIRST_WORKER = 60.0
"""Seconds of real time within which a cluster has its first worker."""


class ClusterPool:
    """A cluster that carries out runs: `client` is a `dask.distributed.Client`, a cluster, or the address of a scheduler."""

    def __init__(self, setting: Setting, client: Any) -> None:
        self._client, self._is_own = connected(client)
        self._key = setting.key
        self._futures: list[Any] = []
        try:
            _check_workers(self._client)
        except BaseException:
            self.close()
            raise
        # a task, and nothing scattered: Dask makes it once more if the only worker that has it dies
        self._setting = self._client.submit(_itself, setting, pure=False)

    def carry_out(self, runs: Sequence[Run]) -> Iterator[tuple[Run, Ending]]:
        """Carry out runs; they come in the order in which they end."""
        from distributed import KilledWorker, as_completed

        self._futures = self._client.map(_carry_out_there, runs, setting=self._setting, pure=False)
        of = dict(zip((future.key for future in self._futures), runs, strict=True))
        for future in as_completed(self._futures):
            try:
                ending = future.result()
            except KilledWorker:
                ending = Ending(DIED, error="several workers of the cluster died in the middle of this run")
            yield of[future.key], ending

    def close(self) -> None:
        """End what goes on, and the connection if it was made here."""
        with contextlib.suppress(Exception):  # a cluster that is gone has nothing to end
            self._client.cancel(self._futures)
            self._client.run(_end_there, self._key, on_error="ignore")
        self._futures = []
        if self._is_own:
            self._client.close()


def connected(client: Any, patience: float = PATIENCE) -> tuple[Client, bool]:
    """A client, and whether it was made here. Raises ExperimentError if there is no cluster, or none within some time (s)."""
    try:
        from distributed import Client
        from distributed.comm.addressing import get_address_host_port
    except ImportError:
        raise ExperimentError("a cluster needs Dask, which is not here: pip install 'turtle-lesson[cluster]'") from None
    if isinstance(client, Client):
        if client.status != "running" or client.asynchronous:
            raise ExperimentError(f"this client is closed or asynchronous: make a new Client(…), got {client}")
        return client, False
    try:
        if isinstance(client, str):  # a Client that cannot connect complains once more when it is collected
            with socket.create_connection(get_address_host_port(client), patience):
                pass
        return Client(client, timeout=patience, set_as_default=False), True
    except (OSError, ValueError, TypeError) as error:
        raise ExperimentError(
            f'no scheduler of Dask answers at {client!r} ({error}). An address looks like "tcp://10.0.0.1:8786"; '
            "`dask scheduler` prints its own"
        ) from None


def answers(client: Client, question: Callable[[], T], patience: float) -> dict[str, T | Exception]:
    """What each worker answers, by its address. Raises ExperimentError if the cluster has none within some time (s)."""
    try:
        client.wait_for_workers(1, timeout=patience)
    except TimeoutError:
        raise ExperimentError(f"the cluster has no workers, and none came within {patience:g} s") from None
    return client.run(question, on_error="return")


def _check_workers(client: Client) -> None:
    """Raise ExperimentError for a cluster without workers, or with workers that lack what runs need."""
    mine = _about()
    for address, about in answers(client, _about, FIRST_WORKER).items():
        if about != mine:
            raise ExperimentError(f"the worker {address} has {about}, and this notebook {mine}: they must be the same")


_workers: dict[str, Workers] = {}
"""What is kept here of each experiment."""


def _itself(setting: Setting) -> Setting:
    return setting


def _about() -> str:
    return f"turtle_lesson {VERSION} on Python {'.'.join(platform.python_version_tuple()[:2])}"


def _carry_out_there(run: Run, setting: Setting) -> Ending:
    """Carry out a run in a process of this worker's."""
    return _workers.setdefault(setting.key, Workers(setting)).carry_out(run)


def _end_there(key: str) -> None:
    if workers := _workers.pop(key, None):
        workers.close()
