"""`threading.Thread` in a simulated process: a strand of it, in virtual time.

The class stays Python's own; `start` decides whose thread it is. A thread begins at once: its starter continues
when it waits for the first time, as in Python, where `start` waits until the thread runs. In the notebook it begins at
this instant of robot time, and lives on whenever the simulation runs.
"""

from __future__ import annotations

import sys
import threading
import time
from traceback import format_exception_only
from typing import TYPE_CHECKING, Any

from ..driving import drive
from ..strand import GreenletExit, Strand, running_strand
from ..tracebacks import format_error, learners_frames
from .home import is_called_by_learner, notebook_here, process_here
from .hopeless import look_after
from .identity import become, end
from .pools import is_worker, remember

if TYPE_CHECKING:
    from ..process import Process

real_start = threading.Thread.start


def start(self: threading.Thread) -> None:
    """Start the thread's activity. RuntimeError if that was done before."""
    process = process_here()
    if process is None:
        real_start(self)
        return
    if not self._initialized:  # type: ignore[attr-defined]
        raise RuntimeError("thread.__init__() not called")
    if self._started.is_set():  # type: ignore[attr-defined]
        raise RuntimeError("threads can only be started once")
    _begin(self, process)


def _begin(thread: threading.Thread, process: Process) -> None:
    simulation, starter = process.simulation, running_strand()
    strand = process.add_strand(lambda: _run(thread, strand))
    become(thread, strand)
    if is_worker(thread):
        remember(process)
    strand.parked = True
    simulation.wake(strand)
    if starter is not None:
        simulation.at(simulation.now, simulation.wake, starter)
        simulation.park(starter)
    elif not simulation.running:
        simulation.settle()


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


def wait_for_end(real: Any) -> Any:
    """`Thread._wait_for_tstate_lock` of Python up to 3.12, which takes an interrupted wait for the thread's end."""

    def wait_for_tstate_lock(self: Any, block: bool = True, timeout: float = -1) -> None:
        handle = vars(self).get("_virtual")
        if handle is None:
            real(self, block, timeout)
        elif self._tstate_lock is not None and handle.lock.acquire(block, timeout):
            handle.lock.release()
            self._stop()

    return wait_for_tstate_lock


def sleep_of_a_cell(seconds: float) -> bool:
    """Sleep in robot time, if a cell of the learner's does, and a thread lives that cells have started; whether it did."""
    notebook = notebook_here()
    if notebook is None or notebook.simulation.running or not is_called_by_learner():
        return False
    threads = [strand.thread for strand in notebook.strands if not strand.dead]
    if not any(thread is not None and "_virtual" in vars(thread) for thread in threads):
        return False
    drive(notebook.simulation, notebook, time.sleep, seconds)
    return True


def start_new_thread(real: Any, function: Any, args: tuple[Any, ...], kwargs: dict[str, Any] | None = None, /) -> int:
    """`_thread.start_new_thread`, which is older and does less."""
    if running_strand() is None:
        return real(function, args, kwargs or {})
    thread = threading.Thread(target=function, args=args, kwargs=kwargs, daemon=True)
    thread.start()
    return thread.ident or 0
