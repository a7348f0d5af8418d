"""`threading` in a simulated process: threads, their identity, pools of them, and what happens to them when a program ends."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import thread as pool
from traceback import format_exception_only
from typing import TYPE_CHECKING, Any
from weakref import WeakMethod

from greenlet import GreenletExit

from ..sim.errors import format_error, learners_frames
from ..sim.run_blocking import drive
from ..sim.simulation import CLOCK_READ, NANOSECONDS
from ..sim.strand import Strand, running_strand
from .deadlock import look_after, looked_in_vain
from .locks import VirtualLock
from .ownership import is_called_by_learner, notebook_here, process_here

if TYPE_CHECKING:
    from ..sim.process import Process


def start(real: Any, self: Any) -> None:
    """`Thread.start`: a simulated thread is a strand, and begins at once.

    Its starter continues when it waits for the first time, as in Python, where `start` waits until the thread runs. In the
    notebook it begins at this instant of robot time, and lives on whenever the simulation runs.
    """
    process = process_here()
    if process is None:
        real(self)
        return
    if not self._initialized:
        raise RuntimeError("thread.__init__() not called")
    if self._started.is_set():
        raise RuntimeError("threads can only be started once")
    simulation, starter = process.simulation, running_strand()
    strand = process.add_strand(lambda: _run(self, strand))
    become(self, strand)
    strand.parked = True
    simulation.wake(strand)
    if starter is not None:
        simulation.at(simulation.now, simulation.wake, starter)
        simulation.park(starter)
    elif not simulation.running:
        simulation.settle()


def join(real: Any, self: Any, timeout: float | None = None) -> None:
    """`Thread.join`."""
    lock = _lock_of(self)
    if lock is None:
        real(self, timeout)
    elif self is threading.current_thread():
        raise RuntimeError("cannot join current thread")
    elif lock.acquire(True, -1 if timeout is None else max(timeout, 0)):
        lock.release()


def is_alive(real: Any, self: Any) -> bool:
    """`Thread.is_alive`."""
    lock = _lock_of(self)
    if lock is None:
        return real(self)
    return lock.locked() and not looked_in_vain()


def _lock_of(thread: threading.Thread) -> VirtualLock | None:
    """The lock that a simulated thread holds until it ends; None for a real one, and for one that was not started."""
    return vars(thread).get("_virtual")


def _run(thread: threading.Thread, strand: Strand) -> None:
    try:
        thread.run()
    except GreenletExit:
        raise
    except SystemExit:
        pass  # ends this thread alone, in silence
    except BaseException as error:
        _tell(thread, strand, error)
    finally:
        end(thread)
        look_after(strand)


def _tell(thread: threading.Thread, strand: Strand, error: BaseException) -> None:
    """Say that an error has ended a thread: by the program's own hook, or with the learner's lines alone."""
    modules, hook = strand.process.modules, threading.excepthook
    if modules is not None and modules.made(hook):
        hook(threading.ExceptHookArgs((type(error), error, error.__traceback__, thread)))
        return
    lines = [format_error(error)] if learners_frames(error.__traceback__) else format_exception_only(error)
    print(f"Exception in thread {thread.name}:\n{''.join(lines)}", end="", file=sys.stderr)


def sleep(real: Callable[[float], None], seconds: float, /) -> None:
    """`time.sleep`: in a simulated process it holds up this strand alone, in virtual time."""
    strand = running_strand()
    if strand is None:
        if not _sleep_of_a_cell(seconds):
            real(seconds)
        return
    if seconds < 0:
        raise ValueError("sleep length must be non-negative")
    strand.simulation.sleep_until(strand.simulation.now + max(CLOCK_READ, round(seconds * NANOSECONDS)))


def _sleep_of_a_cell(seconds: float) -> bool:
    """Sleep in robot time, if a cell of the learner's does, and a thread lives that cells have started; whether it did."""
    notebook = notebook_here()
    if notebook is None or notebook.simulation.running or not is_called_by_learner():
        return False
    threads = [strand.thread for strand in notebook.strands if not strand.dead]
    if not any(thread is not None and "_virtual" in vars(thread) for thread in threads):
        return False
    drive(notebook, time.sleep, seconds)
    return True


# -- which thread is this? ---------------------------------------------------------------------------------------------


def thread_of(strand: Strand) -> threading.Thread:
    """The thread object of a strand, made when it is first asked for."""
    if strand.thread is None:
        is_main = strand is strand.process.main_strand
        name = "MainThread" if is_main else strand.name or "Dummy"
        become(threading.Thread(name=name, daemon=not is_main), strand)
    return strand.thread


def become(thread: threading.Thread, strand: Strand) -> None:
    """Let a thread object stand for a strand, as if it had been started."""
    process, state, lock = strand.process, vars(thread), VirtualLock(owned=True)
    lock.acquire(False)
    lock.owner = strand
    strand.thread, state["_strand"], state["_virtual"] = thread, strand, lock
    state["_ident"] = state["_native_id"] = (process.pid << 16) + process.next_number("threads")
    state["_started"].set()


def end(thread: threading.Thread) -> None:
    """The thread has ended: the threads that join it continue."""
    lock = _lock_of(thread)
    if lock is not None and lock.locked():
        lock.release()


IDENTITY: dict[str, Callable[[Strand], Any]] = {
    "get_ident": lambda strand: thread_of(strand).ident or 0,
    "get_native_id": lambda strand: thread_of(strand).native_id or 0,
    "current_thread": thread_of,
}
"""By name in `threading`, what tells of the running thread; the number of the system is the same number."""


def main_thread(real: Any) -> threading.Thread:
    """The main thread of the running process."""
    strand = running_strand()
    if strand is None or strand.process.main_strand is None:
        return real()
    return thread_of(strand.process.main_strand)


def enumerate(real: Any) -> list[threading.Thread]:
    """The threads that live in the running process."""
    strand = running_strand()
    if strand is not None and strand.process.main_strand is not None:
        return _threads(strand.process)
    process = strand.process if strand is not None else notebook_here()
    return real() + (_threads(process) if process is not None else [])


def active_count(real: Any) -> int:
    """How many there are."""
    return len(threading.enumerate())


def _threads(process: Process) -> list[threading.Thread]:
    """The simulated threads of a process that live."""
    threads = [thread_of(strand) for strand in process.strands if not strand.dead]
    return [thread for thread in threads if "_virtual" in vars(thread) and thread.is_alive()]


def newname(real: Any, name_template: str) -> str:
    """A name for a thread; those of each simulated process are numbered by themselves."""
    process = process_here()
    return real(name_template) if process is None else name_template % process.next_number(name_template)


# -- pools -------------------------------------------------------------------------------------------------------------
# What depends on the machine or on other processes is set: a pool has eight threads unless told otherwise, and its name
# counts by process. When the main program ends, pools finish what they have been given.

MOST_WORKERS = 8
"""How many threads a pool has on a computer with four cores, which a simulated one is."""


def number_of_pool(process: Process) -> int:
    """The number of one more pool of a process, from 0."""
    return process.next_number("pools") - 1


def init(
    real: Any, self: Any, max_workers: int | None = None, thread_name_prefix: str = "", *arguments: Any, **keywords: Any
) -> None:
    """`ThreadPoolExecutor.__init__`."""
    process = process_here()
    if process is None:
        real(self, max_workers, thread_name_prefix, *arguments, **keywords)
        return
    workers = MOST_WORKERS if max_workers is None else max_workers
    real(self, workers, thread_name_prefix or f"ThreadPoolExecutor-{number_of_pool(process)}", *arguments, **keywords)
    method = WeakMethod(self.shutdown)  # a pool that nobody holds any more ends by itself

    def end() -> None:
        shutdown = method()
        if shutdown is not None:
            shutdown()

    process.before_exit.append(end)


def adjust(real: Any, self: Any) -> None:
    """`ThreadPoolExecutor._adjust_thread_count`, which notes threads that Python joins at its end: no simulated ones."""
    real(self)
    noted: Any = pool._threads_queues
    for thread in self._threads:
        if _lock_of(thread) is not None:
            noted.pop(thread, None)


# -- ending ------------------------------------------------------------------------------------------------------------


def wind_down(process: Process) -> None:
    """Wait for what is still at work in a process whose main program has ended; its main strand calls this.

    The order is CPython's: pools end their work, then the threads that are no daemons are waited for, then comes what was given
    to `atexit.register`. Daemons end with the process, wherever they stand.
    """
    try:
        while process.before_exit:
            process.before_exit.pop()()
        if process.main_strand is not None and any(strand.thread is not None for strand in process.strands):
            end(thread_of(process.main_strand))
            while waited_for := [thread for thread in _threads(process) if not thread.daemon]:
                waited_for[0].join()
    except KeyboardInterrupt as error:  # Ctrl-C ends the waiting
        print(f"Exception ignored in: <module 'threading'>\n{format_error(error)}", end="", file=sys.stderr)
    while process.exit_functions:
        function = process.exit_functions.pop()
        try:
            function()
        except SystemExit:
            pass
        except Exception as error:
            print(f"Exception ignored in atexit callback:\n{format_error(error)}", end="", file=sys.stderr)
