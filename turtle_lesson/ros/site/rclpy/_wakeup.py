"""What holds up a thread until a time has come, or something happened before."""

from __future__ import annotations

from typing import TYPE_CHECKING

from turtle_lesson.ros.sim.strand import Strand, running_strand
from turtle_lesson.ros.stdlib.deadlock import wait_in_vain

from ._deadlock import executor_of_worker, is_notebook

if TYPE_CHECKING:
    from .context import Context
    from .executors import Executor


class Alarm:
    """Holds up the running strand in `wait`, until a time of the simulation, or until somebody calls `ring`.

    A shutdown of its context rings it, too.
    """

    def __init__(self, context: Context) -> None:
        strand = running_strand()
        assert strand is not None
        self.strand = strand
        self.rung = False
        self._context = context
        context.wake_at_the_end(self.ring)

    def ring(self) -> None:
        """End the waiting."""
        self.rung = True
        self.strand.simulation.wake(self.strand)

    def wait(self, deadline: int | None, *, only_from_within: bool = True) -> bool:
        """Wait until the deadline (ns of the simulation; None forever); whether it rang before.

        `only_from_within`: nobody but another thread of this process can ring it.
        """
        simulation, strand = self.strand.simulation, self.strand
        if deadline is not None and simulation.now < deadline:
            simulation.at(deadline, simulation.wake, strand)
        try:
            while not self.rung and (deadline is None or simulation.now < deadline):
                if deadline is None and only_from_within:
                    wait_in_vain(strand, "the next tick")
                simulation.park(strand)
        finally:
            strand.waits_for = None
            self._context.let_sleep(self.ring)
        return self.rung


def somebody_spins(executor: Executor | None, strand: Strand) -> bool:
    """Whether another strand than this spins an executor, or may do so yet (in doubt: yes)."""
    if is_notebook(strand.process):
        return True
    if executor is not None and executor._spun_by_another(strand):
        return True
    others = (each for each in strand.process.strands if each is not strand and not each.dead)
    return any(executor_of_worker(each) is None for each in others)
