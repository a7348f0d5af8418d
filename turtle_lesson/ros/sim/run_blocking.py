"""Blocking calls from plain Python code, such as a notebook cell: the simulation is run until the call is done."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from .. import hooks
from .errors import DriveTimeout, NeverWakes, SimulationError
from .interrupts import Guard
from .simulation import NANOSECONDS, NEVER

if TYPE_CHECKING:
    from .process import Process
    from .simulation import Simulation
    from .strand import Strand

DRIVE_LIMIT = 900 * NANOSECONDS
"""How much robot time, in ns, a blocking call from a notebook cell may take before it is given up."""

_current_thread = threading.current_thread  # the real one, whatever it becomes

LOCK = "the lock"
"""What a strand waits for of which no more is known."""

T = TypeVar("T")


class Call:
    """A call that runs in a strand of its own, and what has become of it."""

    def __init__(self, process: Process, function: Callable[..., Any], *arguments: Any, **keywords: Any) -> None:
        self.simulation = process.simulation
        self.function, self.arguments, self.keywords = function, arguments, keywords
        self.done = False
        self.value: Any = None
        self.error: BaseException | None = None
        self.strand: Strand = process.add_strand(self._run)
        self.strand.thread = _current_thread()  # for the learner it is the cell that calls
        self.simulation.driven = self.strand
        self.simulation.put_back(self.strand)

    def _run(self) -> None:
        try:
            self.value = self.function(*self.arguments, **self.keywords)
        except BaseException as error:
            self.error = error
        self.done = True
        self.simulation.call_done(self.strand)

    def give_up(self, error: BaseException) -> None:
        """Raise `error` where the call waits; if it goes on waiting all the same, it is never run again."""
        if self.done:
            return
        self.simulation.raise_in(self.strand, error)
        if not self.done:
            self.simulation.forget(self.strand)
            self.error = error


def drive(
    process: Process, function: Callable[..., T], *arguments: Any, limit: int = DRIVE_LIMIT, **keywords: Any
) -> T:
    """Run the simulation until `function(*arguments, **keywords)`, called as part of `process`, has returned.

    Raises what the function raises, DriveTimeout after `limit` ns of robot time, and KeyboardInterrupt if the user interrupts:
    the call then gets it, too.
    """
    simulation = process.simulation
    with Guard(simulation) as guard:  # from here on an interrupt is noted, and raised as the very last act
        simulation.check_it_can_run()
        call = Call(process, function, *arguments, **keywords)
        simulation.run_guarded(simulation.now + limit)
        simulation.driven = None
        if not call.done:
            call.give_up(KeyboardInterrupt() if guard.interrupted else why_not_done(simulation, call.strand, limit))
        if call.error is not None:
            raise call.error
    return call.value


def why_not_done(simulation: Simulation, strand: Strand, limit: int) -> SimulationError:
    """The error for a call that did not end: nothing is left that could end it, or it took longer than the limit (ns)."""
    what = strand.activity or hooks.name_of_wait(strand)
    if what == LOCK and strand.waits_for is None:
        what = "this call"
    if simulation.next_event == NEVER:
        return NeverWakes(
            f"{what} waits for something that can never happen: nothing in this world is running any more. "
            "Start what should answer (ros2 run, lesson.launch), or give a timeout."
        )
    return DriveTimeout(
        f"{what} was still not done after {limit // NANOSECONDS} s of robot time, so it was given up. "
        "Does a node publish what it waits for, or offer the service, under exactly that name (`ros2 topic list`, "
        "`ros2 service list`)? A timeout_sec lets you decide how long to wait."
    )
