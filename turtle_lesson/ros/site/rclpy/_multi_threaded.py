"""The executor with several threads, each of which is a strand."""

from __future__ import annotations

import warnings
from contextlib import suppress

from turtle_lesson.ros.core import NeverWakes, Strand, running_strand
from turtle_lesson.ros.core.stdlib.hopeless import IDLE, look_after, wait_in_vain
from turtle_lesson.ros.core.stdlib.pools import number_of_pool
from turtle_lesson.ros.core.strand import GreenletExit
from turtle_lesson.ros.core.tracebacks import print_error
from turtle_lesson.ros.distro import SHUTDOWN_WAITS_FOR_THREADS
from turtle_lesson.ros.world import current_world

from ._blocking import drive
from ._deadlock import executor_of_worker, know_worker
from ._executor import Condition, Executor, Job
from ._executor_errors import ExternalShutdownException
from ._notebook import is_notebook
from .context import Context


class MultiThreadedExecutor(Executor):
    """Runs callbacks side by side in up to `num_threads` threads (4 unless told), as their groups allow.

    The threads are strands: while one waits or sleeps, another runs; none runs at the same instant of real time.
    """

    __module__ = "rclpy.executors"

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        self._num_threads = 4 if num_threads is None else num_threads
        if self._num_threads < 1:
            raise ValueError(f"num_threads must be at least 1, got {num_threads}")
        if self._num_threads == 1:
            warnings.warn(
                "MultiThreadedExecutor is used with a single thread.\nUse the SingleThreadedExecutor instead.",
                stacklevel=2,
            )
        self._threads = 0
        self._idle: list[_Worker] = []
        self._failures: list[BaseException] = []

    def _spun_by_another(self, strand: Strand) -> bool:
        free = self._num_threads - sum(not answer.done() for answer in self._calls) - self._is_worker(strand)
        return super()._spun_by_another(strand) and free > 0

    def _is_worker(self, strand: Strand) -> bool:
        """Whether this strand is one of this executor's threads."""
        return executor_of_worker(strand) is self

    def _next(self, strand: Strand, deadline: int | None, condition: Condition) -> Job | None:
        while not self._idle and self._threads >= self._num_threads and not self._failures:
            if condition is not None and condition():
                return None
            if deadline is not None and self._simulation.now >= deadline:
                return None
            if self._is_shutdown or not self._context.ok():
                self._say_it_is_shut_down()
            self._wait(strand, deadline)

        def interesting() -> bool:
            return bool(self._failures) or (condition is not None and condition())

        job = None if self._failures else super()._next(strand, deadline, interesting)
        if job is None and self._failures:
            raise self._failures.pop(0)
        return job

    def _spin_once(self, strand: Strand, deadline: int | None, condition: Condition) -> None:
        with suppress(
            ExternalShutdownException
        ):  # as the real one does (executors.py); a single-threaded one raises it
            super()._spin_once(strand, deadline, condition)
        if is_notebook(strand.process):
            self._let_workers_go_on(strand)

    def _let_workers_go_on(self, strand: Strand) -> None:
        """When a cell's call returns, time stands still: what is ready must run before, or it would not be seen."""
        simulation = self._simulation
        simulation.at(simulation.now, simulation.wake, strand)
        simulation.park(strand)
        if self._failures:
            raise self._failures.pop(0)

    def _execute(self, job: Job) -> None:
        worker = self._idle.pop() if self._idle else self._new_worker()
        worker.give(job)

    def _new_worker(self) -> _Worker:
        if not self._threads:
            self._pool = number_of_pool(self._process)
            self._process.before_exit.append(self._let_callbacks_end)
        worker = _Worker(self, f"ThreadPoolExecutor-{self._pool}_{self._threads}")
        self._threads += 1
        know_worker(worker._strand, self)
        return worker

    def _execute_here(self, job: Job) -> None:
        super()._execute(job)

    def shutdown(self, timeout_sec: float | None = None, *, wait_for_threads: bool = True) -> bool:
        """Stop: no more callbacks are run. Since Kilted, wait until those that have begun are done, unless told not to."""
        done = super().shutdown(timeout_sec)
        strand = running_strand()
        own = strand is not None and self._is_worker(strand)  # a callback cannot wait for its own end
        if wait_for_threads and not own and current_world().release.has(SHUTDOWN_WAITS_FOR_THREADS):
            drive(self._let_callbacks_end) if strand is None else self._let_callbacks_end()
        return done

    def _let_callbacks_end(self) -> None:
        """The program ends, or the executor: callbacks that are in their middle go on to their end, as in Python's pools."""
        strand = running_strand()
        assert strand is not None
        self._begin_waiting(strand)
        try:
            while len(self._idle) < self._threads:
                wait_in_vain(strand, "the callbacks that still run")
                strand.park()
        finally:
            strand.waits_for = None
            self._end_waiting(strand)
        for error in self._failures:
            if isinstance(error, NeverWakes):
                print_error(error)


class _Worker:
    """One thread of a multi-threaded executor: a strand that runs the jobs it is given."""

    def __init__(self, executor: MultiThreadedExecutor, name: str) -> None:
        self._executor = executor
        self._strand = executor._process.add_strand(self._loop)
        self._strand.name = name
        self._strand.waits_for = IDLE
        self._strand.parked = True
        self._job: Job | None = None

    def give(self, job: Job) -> None:
        self._job = job
        self._strand.simulation.wake(self._strand)

    def _loop(self) -> None:
        executor = self._executor
        while True:
            while self._job is None:
                self._strand.waits_for = IDLE
                if executor._waiter is None:
                    look_after(self._strand)  # nobody spins: may those who wait still hope for anything?
                self._strand.park()
            self._strand.waits_for = None
            job, self._job = self._job, None
            try:
                executor._execute_here(job)
            except GreenletExit:
                raise
            except BaseException as error:  # also sys.exit(): it ends the program where the executor is spun
                executor._failures.append(error)
            executor._idle.append(self)
            executor.wake()
