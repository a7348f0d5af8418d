"""Which thread is this? Strands of a simulated process have `threading.Thread` objects and numbers of their own."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..strand import Strand, getcurrent
from .home import notebook_here, process_here
from .locks import VirtualLock
from .looking import looked_in_vain

if TYPE_CHECKING:
    from ..process import Process

HAS_HANDLES = hasattr(threading, "_ThreadHandle")
"""Python 3.13 and newer keep in an object of its own whether a thread has ended."""


class Handle:
    """Knows whether a simulated thread has ended, and waits for that."""

    def __init__(self, ident: int) -> None:
        self.ident = ident
        self.lock = VirtualLock()

    def is_done(self) -> bool:
        """Whether it has ended."""
        return not self.lock.locked() or looked_in_vain()

    def join(self, timeout: float | None = None) -> None:
        """Wait until it has, at most `timeout` s."""
        if self.lock.acquire(True, -1 if timeout is None else timeout):
            self.lock.release()


class _MainThread(threading.Thread):
    """The main thread of a simulated process."""

    def __init__(self) -> None:
        super().__init__(name="MainThread", daemon=False)


class _DummyThread(threading.Thread):
    """A thread that nobody has started by `threading`, such as a worker of an executor."""

    def __init__(self, name: str) -> None:
        super().__init__(name=name, daemon=True)


def thread_of(strand: Strand) -> threading.Thread:
    """The thread object of a strand, made when it is first asked for."""
    if strand.thread is None:
        kind = _MainThread() if strand is strand.process.main_strand else _DummyThread(strand.name or "Dummy")
        become(kind, strand)
    return strand.thread


def become(thread: threading.Thread, strand: Strand) -> None:
    """Let a thread object stand for a strand, as if it had been started."""
    process, state = strand.process, vars(thread)
    handle = Handle(process.next_ident())
    handle.lock.acquire(False)
    handle.lock.owner, handle.lock.surely = strand, True
    strand.thread, state["_strand"] = thread, strand
    state["_ident"] = state["_native_id"] = handle.ident
    if HAS_HANDLES:
        state["_handle"] = handle
    else:
        state["_tstate_lock"] = handle.lock
    state["_virtual"] = handle
    state["_started"].set()


def end(thread: threading.Thread) -> None:
    """The thread has ended: the threads that join it continue."""
    handle: Handle = vars(thread)["_virtual"]
    if handle.lock.locked():
        handle.lock.release()


# -- what programs ask ---------------------------------------------------------------------------------------------------


def get_ident(real: Any) -> int:
    """The number of the running thread."""
    strand = getcurrent()
    return real() if type(strand) is not Strand else thread_of(strand).ident or 0


def get_native_id(real: Any) -> int:
    """The same number."""
    strand = getcurrent()
    return real() if type(strand) is not Strand else thread_of(strand).native_id or 0


def current_thread(real: Any) -> threading.Thread:
    """The running thread."""
    strand = getcurrent()
    return real() if type(strand) is not Strand else thread_of(strand)


def main_thread(real: Any) -> threading.Thread:
    """The main thread of the running process."""
    strand = getcurrent()
    if type(strand) is not Strand or strand.process.main_strand is None:
        return real()
    return thread_of(strand.process.main_strand)


def enumerate(real: Any) -> list[threading.Thread]:
    """The threads that live in the running process."""
    strand = getcurrent()
    if type(strand) is Strand and strand.process.main_strand is not None:
        return _threads(strand.process)
    process = strand.process if type(strand) is Strand else notebook_here()
    return real() + (_threads(process) if process is not None else [])


def active_count(real: Any) -> int:
    """How many there are."""
    return len(threading.enumerate())


def _threads(process: Process) -> list[threading.Thread]:
    threads = [thread_of(strand) for strand in process.strands if not strand.dead]
    return [thread for thread in threads if "_virtual" in vars(thread) and thread.is_alive()]


def _newname(real: Any, name_template: str) -> str:
    """A name for a thread; those of each simulated process are numbered by themselves."""
    process = process_here()
    if process is None:
        return real(name_template)
    counts: dict[str, int] = process.locals.setdefault("threading.names", {})
    counts[name_template] = counts.get(name_template, 0) + 1
    return name_template % counts[name_template]


REPLACEMENTS: tuple[Callable[..., Any], ...] = (
    get_ident,
    get_native_id,
    current_thread,
    main_thread,
    enumerate,
    active_count,
    _newname,
)
