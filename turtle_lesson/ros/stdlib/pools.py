"""`concurrent.futures` and queues in a simulated process: Python's own, on virtual locks.

What depends on the machine or on other processes is set: a pool has eight threads unless told otherwise, and counts
its names by process. When the main program ends, pools finish what they have been given.
"""

from __future__ import annotations

import queue
from collections import UserDict, deque
from collections.abc import MutableMapping
from concurrent.futures import thread as pool
from dataclasses import dataclass, field
from threading import Semaphore
from typing import TYPE_CHECKING, Any

from greenlet import getcurrent

from ..sim.strand import Strand
from .ownership import process_here

if TYPE_CHECKING:
    import threading

    from ..sim.process import Process


MOST_WORKERS = 8
"""How many threads a pool has on a computer with four cores, which a simulated one is."""


class VirtualSimpleQueue:
    """What `queue.SimpleQueue()` is in a simulated process."""

    __module__ = "queue"

    def __init__(self) -> None:
        self._items: deque[Any] = deque()
        self._count = Semaphore(0)

    def put(self, item: Any, block: bool = True, timeout: float | None = None) -> None:
        """Add an item; there is always room."""
        self._items.append(item)
        self._count.release()

    def get(self, block: bool = True, timeout: float | None = None) -> Any:
        """Take the oldest item, waiting for one if `block`, at most `timeout` s. queue.Empty if there is none."""
        if timeout is not None and timeout < 0:
            raise ValueError("'timeout' must be a non-negative number")
        if not self._count.acquire(block, timeout):
            raise queue.Empty
        return self._items.popleft()

    def put_nowait(self, item: Any) -> None:
        """As `put`."""
        self.put(item)

    def get_nowait(self) -> Any:
        """As `get(False)`."""
        return self.get(False)

    def empty(self) -> bool:
        """Whether there is no item."""
        return not self._items

    def qsize(self) -> int:
        """How many items there are."""
        return len(self._items)


@dataclass
class _Pools:
    """The pools of a process: how many were made, whether they end with it, and the queue of each worker."""

    made: int = 0
    end_with_it: bool = False
    queues: dict[threading.Thread, Any] = field(default_factory=dict)


def next_number(real: Any) -> int:
    """Numbers the pools, those of each simulated process by themselves."""
    process = process_here()
    return real() if process is None else number_of_pool(process)


def number_of_pool(process: Process) -> int:
    """The number of one more pool of a process."""
    own = process.state(_Pools)
    own.made += 1
    return own.made - 1


class NotInStrands:
    """A lock against the end of Python itself, which can't come while a simulated process runs."""

    def __init__(self, real: Any) -> None:
        self._lock = real

    def __enter__(self) -> None:
        if type(getcurrent()) is not Strand:
            self._lock.acquire()

    def __exit__(self, *error: object) -> None:
        if type(getcurrent()) is not Strand:
            self._lock.release()


def init(real: Any, self: Any, max_workers: int | None = None, *arguments: Any, **keywords: Any) -> None:
    """`ThreadPoolExecutor.__init__`."""
    if max_workers is None and process_here() is not None:
        max_workers = MOST_WORKERS
    real(self, max_workers, *arguments, **keywords)


def is_worker(thread: threading.Thread) -> bool:
    """Whether a thread is one of a pool's."""
    return getattr(thread, "_target", None) is pool._worker


def remember(process: Process) -> None:
    """A thread of a pool starts: before the process ends, its pools are to end."""
    own = process.state(_Pools)
    if not own.end_with_it:
        own.end_with_it = True
        process.before_exit.append(lambda: end_pools(process))


def end_pools(process: Process) -> None:
    """Have the pools of a process do what they have been given, and end their threads."""
    queues = process.state(_Pools).queues
    workers = [(thread, work) for thread, work in queues.items() if thread.is_alive()]
    for thread, work in workers:
        executor = thread._args[0]()  # type: ignore[attr-defined]  # a weak reference
        if executor is not None:
            executor._shutdown = True
        work.put(None)
    for thread, _ in workers:
        thread.join()


class Queues(UserDict[Any, Any]):
    """By thread, the queue from which it gets its work. Python waits for these threads when it ends.

    It need not wait for those of simulated processes: they are kept by the process. The others are in the `real` one.
    """

    def __init__(self, real: MutableMapping[Any, Any]) -> None:
        self.data = real  # type: ignore[assignment]  # it is shared, and goes by weak references

    def __setitem__(self, thread: Any, work: Any) -> None:
        strand = vars(thread).get("_strand")
        own = self.data if strand is None else strand.process.state(_Pools).queues
        own[thread] = work
