"""A strand: one line of execution in a simulated process, which can stop in the middle of a call and go on later.

This module is the small switch interface between the simulation and whatever makes a call stoppable; today that is
greenlet (https://greenlet.readthedocs.io). Nothing else in the project imports greenlet.

A strand is *parked* (waits until somebody wakes it), *ready* (queued to go on at this instant), *running* or *dead*.
The hub is the greenlet that runs the simulation's loop: the notebook cell itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from greenlet import GreenletExit, getcurrent, greenlet

__all__ = ["GreenletExit", "Strand", "getcurrent", "greenlet", "running_greenlet", "running_strand"]

if TYPE_CHECKING:
    from .cell_context import Cell
    from .process import Process
    from .simulation import Simulation


class Strand(greenlet):
    """One line of execution of a process: its main program, a thread, or a worker of a multi-threaded executor.

    Attributes:
        process: the process that it belongs to.
        simulation: that process's simulation.
        parked: whether it waits to be woken.
        activity: what it does, for messages that explain why it takes so long.
        warned: whether it was told once that it computes without end.
        frozen_at: the virtual time (ns) at which it was last frozen in the middle of a computation; -1 before that.
        cell: the cell that it prints to.
        waits_for: what it waits for without a time limit, and without end if all others of its process do so; None otherwise.
        may_act: asks whether anything that it waits for could have it go on; None if that is not known.
        name: what it is called, if nobody gives it another name.
        thread: the `threading.Thread` that it is, once somebody has asked.
        calls: functions to be called in it where it waits, such as handlers of signals.
    """

    process: Process
    simulation: Simulation
    parked: bool
    activity: str
    warned: bool
    frozen_at: int = -1
    cell: Cell | None = None
    waits_for: Any = None
    may_act: Callable[[], bool] | None = None
    name: str = ""
    thread: Any = None
    calls: Sequence[Callable[[], object]] = ()

    def __init__(self, process: Process, target: Callable[[], Any]) -> None:
        super().__init__(target)
        self.process = process
        self.simulation = process.simulation
        self.parked = False
        self.activity = ""
        self.warned = False
        self.parent = process.simulation.hub
        process.simulation.know(self)

    def park(self) -> None:
        """Stop here until woken. May also return early: callers check what they wait for, in a loop."""
        self.simulation.park(self)

    def go_on(self) -> None:
        """Go on out of turn (called by the hub)."""
        self.parked = False
        self.parent = self.simulation.hub
        self.switch()

    def raise_inside(self, error: BaseException) -> None:
        """Go on, with `error` raised at the place where the strand stopped (called by the hub)."""
        self.parked = False
        self.parent = self.simulation.hub
        self.throw(error)

    def __repr__(self) -> str:
        state = "dead" if self.dead else "parked" if self.parked else "ready or running"
        return f"<Strand of {self.process.name}, {state}>"


def running_strand() -> Strand | None:
    """The strand that runs now, or None in plain Python code such as a notebook cell."""
    current = getcurrent()
    return current if type(current) is Strand else None


def running_greenlet() -> greenlet:
    """The greenlet that runs now, whatever it is: what the simulation takes as its hub."""
    return getcurrent()
