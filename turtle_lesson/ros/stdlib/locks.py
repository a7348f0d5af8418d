"""Locks that hold up a strand in virtual time, and the queue in C. All else in `threading` and `queue` is built on them.

Such a lock is a real one inside. So it may be used from everywhere: another thread of the real computer waits for it in
real time, and in a plain notebook cell waiting for it runs the simulation. Of the threads that wait, the first one is
woken; but a thread that asks while the lock is free gets it, as in Python.
"""

from __future__ import annotations

import queue
import sys
import threading
from _thread import allocate_lock
from collections import deque
from functools import partial
from typing import Any

from ..sim.errors import WorldClosed
from ..sim.run_blocking import drive
from ..sim.simulation import NANOSECONDS
from ..sim.strand import Strand, running_strand
from .deadlock import count_look, wait_in_vain
from .ownership import notebook_here, process_here


def nanoseconds(seconds: float) -> int:
    """A time to wait, in ns; a remainder that rounds to nothing still lets time pass, so that loops come to an end."""
    return max(1, round(seconds * NANOSECONDS)) if seconds > 0 else 0


class VirtualLock:
    """What `threading.Lock()` is in a simulated process.

    Attributes:
        owner: the strand that has it, if one has.
        surely: whether nobody but the owner will release it: it was taken by `with`, or it is part of an RLock.
    """

    __slots__ = ("__weakref__", "_lock", "_owned", "_waiters", "owner", "surely")
    __module__ = "_thread"
    __qualname__ = __name__ = "lock"

    def __init__(self, *, owned: bool = False) -> None:
        self._lock = allocate_lock()
        self._waiters: deque[Strand] = deque()
        self.owner: Strand | None = None
        self.surely = self._owned = owned

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        """Take the lock, waiting for it if `blocking`, at most `timeout` seconds; whether it was taken."""
        strand = running_strand()
        if strand is not None:
            count_look(strand.simulation)  # queues are asked with their lock
        if not self._lock.acquire(False):
            allocate_lock().acquire(blocking, timeout)  # which refuses what a real one refuses
            if not blocking or timeout == 0:
                return False
            if strand is None:
                return self._acquire_outside(timeout)
            if not self._wait(strand, None if timeout < 0 else strand.simulation.now + nanoseconds(timeout)):
                return False
        if strand is not None:
            self.owner = strand
        return True

    def release(self) -> None:
        """Let it go. RuntimeError if nobody has it."""
        self.owner = None
        self.surely = self._owned
        self._lock.release()
        self._wake_one()

    def locked(self) -> bool:
        """Whether somebody has it."""
        return self._lock.locked()

    def __enter__(self) -> bool:
        self.acquire()
        self.surely = True
        return True

    def __exit__(self, *error: object) -> None:
        self.release()

    def _wake_one(self) -> None:
        if self._waiters:
            strand = self._waiters[0]
            strand.simulation.wake(strand)

    def _wait(self, strand: Strand, deadline: int | None) -> bool:
        """Hold the strand up until it has the lock, or until the deadline (ns); whether it has it."""
        take, check = partial(self._lock.acquire, False), partial(wait_in_vain, strand, self)
        self._waiters.append(strand)
        try:
            return strand.simulation.wait_for(strand, take, deadline, check)
        finally:
            self._waiters.remove(strand)
            if not self._lock.locked():  # woken, but called away by an error
                self._wake_one()

    def _acquire_outside(self, timeout: float) -> bool:
        """Wait where no simulated process runs: in a cell by running the simulation, in another thread really."""
        if self.owner is not None and self.owner.simulation.closed:
            raise WorldClosed(
                "this would wait for a thread of a world that was closed by a later start(), and so forever: make new "
                "locks, queues and threads in the new world"
            )
        notebook = notebook_here()
        if notebook is None:
            return self._lock.acquire(True, timeout)
        taken = drive(notebook, self.acquire, True, timeout)
        if taken:
            self.owner = None  # the cell has it now, and not the strand that waited for the cell
        return taken

    def _at_fork_reinit(self) -> None:
        self._lock._at_fork_reinit()  # type: ignore[attr-defined]
        self._waiters.clear()
        self.owner = None


_PythonRLock: Any = getattr(threading, "_RLock", object)


class VirtualRLock(_PythonRLock):
    """What `threading.RLock()` is in a simulated process: Python's own that is written in Python, on a virtual lock."""

    def __init__(self) -> None:
        super().__init__()
        self._block = VirtualLock(owned=True)


def waiter(real: Any) -> Any:
    """`threading._allocate_lock`, which makes the lock by which a `Condition` waits: a virtual one where one is needed."""
    condition = sys._getframe(1).f_locals.get("self")
    virtual = isinstance(getattr(condition, "_lock", None), (VirtualLock, VirtualRLock))
    if virtual or (running_strand() is not None and process_here() is not None):
        return VirtualLock()
    return real()


def rlock(real: Any, *arguments: Any, **keywords: Any) -> Any:
    """`threading.RLock`, which is a function."""
    return (real if process_here() is None else VirtualRLock)(*arguments, **keywords)


def peek(real: Any) -> float:
    """A clock for waiting with a time limit: unlike `time.monotonic`, looking at it takes no virtual time."""
    strand = running_strand()
    if strand is not None:
        return strand.simulation.now / NANOSECONDS
    notebook = notebook_here()
    if notebook is not None and is_virtual(sys._getframe(1).f_locals.get("self")):
        return notebook.simulation.now / NANOSECONDS
    return real()


def is_virtual(waited_for: Any) -> bool:
    """Whether a lock, condition, semaphore or queue is of the simulation."""
    for part in ("_cond", "mutex", "_lock"):
        waited_for = getattr(waited_for, part, waited_for)
        if isinstance(waited_for, (VirtualLock, VirtualRLock)):
            return True
    return False


VirtualSimpleQueue: Any = getattr(queue, "_PySimpleQueue", None)
"""`queue.SimpleQueue` in a simulated process: Python keeps it for systems that have none in C, and it waits for a semaphore."""
