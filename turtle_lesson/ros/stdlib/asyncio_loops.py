"""An asyncio loop that waits in virtual time: Python's own in all but what it waits with.

It runs in a strand and holds up that one alone. A round of the loop that has something to do takes 1 µs, so that a loop that
never waits lets time pass all the same. Each thread of a simulated process has its own loop, as in Python.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from functools import partial
from typing import Any

from ..sim.errors import SimulationError
from ..sim.process import Process
from ..sim.simulation import CLOCK_READ, NANOSECONDS, be_careful
from ..sim.strand import Strand, running_strand
from .deadlock import LOOP, wait_in_vain
from .locks import nanoseconds


class _Loops(dict[Strand, Any]):
    """The asyncio loops of a process, by its threads."""


class VirtualEventLoop(asyncio.BaseEventLoop):
    """What `asyncio.new_event_loop()` makes in a simulated process. It is its own selector, which it waits with."""

    def __init__(self, process: Process) -> None:
        super().__init__()
        be_careful(process.simulation)
        self._process = process
        self._selector = self
        self._waiting: Strand | None = None
        self._woken = False
        self._clock_resolution = 1 / NANOSECONDS
        self._cell: Any = None

    def time(self) -> float:
        """The robot's time, in s, as `time.monotonic()` shows it."""
        return self._process.simulation.now / NANOSECONDS

    def create_task(self, coro: Any, **keywords: Any) -> Any:
        """As in asyncio, but each process counts its tasks for itself."""
        if keywords.get("name") is None:
            keywords["name"] = f"Task-{self._process.next_number('tasks')}"
        return super().create_task(coro, **keywords)

    def call_exception_handler(self, context: Any) -> None:
        """As in asyncio, but silent about tasks that were left when their process or world ended."""
        if self._process.alive and not self._process.simulation.closed:
            super().call_exception_handler(context)

    def __del__(self) -> None:
        if not self.is_closed() and not self.is_running():
            self.close()

    # -- waiting -------------------------------------------------------------------------------------------------------

    def select(self, timeout: float | None = None) -> list[Any]:
        """Let time pass, at most `timeout` s, until something else is called here; None: until then."""
        strand = running_strand()
        if strand is None:
            raise SimulationError("this loop belongs to a simulated process, and can only run in one")
        simulation = strand.simulation
        if timeout is not None and timeout <= 0:
            simulation.sleep_until(simulation.now + CLOCK_READ)
        else:
            deadline = None if timeout is None else simulation.now + nanoseconds(timeout)
            self._waiting = strand
            try:
                simulation.wait_for(strand, lambda: self._woken, deadline, partial(wait_in_vain, strand, LOOP))
            finally:
                self._waiting = None
        self._woken = False
        self._print_to(strand)
        return []

    def _process_events(self, event_list: list[Any]) -> None:
        """There are none."""

    def _write_to_self(self) -> None:
        self._woken = True
        if self._waiting is not None:
            self._waiting.simulation.wake(self._waiting)

    # -- whom it prints to ---------------------------------------------------------------------------------------------

    def _print_to(self, strand: Strand) -> None:
        """Have what was asked for while an earlier cell ran print to the one that runs now."""
        if strand.cell is not self._cell and strand.cell is not None:
            self._cell = strand.cell
            self._cell.show_here()
            for handle in [*self._ready, *self._scheduled]:  # type: ignore[attr-defined]
                self._cell.show_in(handle._context)

    def call_soon(self, callback: Any, *args: Any, context: Any = None) -> Any:  # type: ignore[override]
        """As in asyncio."""
        if context is not None and self._cell is not None:
            self._cell.show_in(context)
        return super().call_soon(callback, *args, context=context)

    # -- what needs the real computer ----------------------------------------------------------------------------------

    def _refused(self, *arguments: Any, **keywords: Any) -> Any:
        raise NotImplementedError(
            "not possible here: files, sockets and processes of the real computer know nothing about virtual time. Of "
            "asyncio tasks, queues, events, sleep and run_in_executor work, and signal.signal."
        )

    add_reader = add_writer = add_signal_handler = sock_connect = sock_recv = sock_sendall = _refused  # type: ignore[assignment]
    subprocess_exec = subprocess_shell = create_connection = create_datagram_endpoint = create_server = _refused
    create_unix_connection = remove_signal_handler = _refused


# -- loop functions ----------------------------------------------------------------------------------------------------


def new_event_loop(strand: Strand) -> Any:
    """A new loop."""
    return VirtualEventLoop(strand.process)


def set_event_loop(strand: Strand, loop: Any) -> None:
    """Set the loop of the running thread."""
    strand.process.state(_Loops)[strand] = loop


def get_event_loop(strand: Strand) -> Any:
    """The loop that runs, or else that of the running thread; in a main thread one is made where there is none."""
    loop = asyncio._get_running_loop()
    if loop is not None:
        return loop
    loops = strand.process.state(_Loops)
    if strand is strand.process.main_strand and strand not in loops:
        loops[strand] = VirtualEventLoop(strand.process)
    if loops.get(strand) is None:
        name = threading.current_thread().name
        raise RuntimeError(f"There is no current event loop in thread {name!r}.")
    return loops[strand]


REPLACEMENTS: tuple[Callable[..., Any], ...] = (new_event_loop, set_event_loop, get_event_loop)
