"""Blocking calls work everywhere: in a simulated process they wait, in a plain notebook cell they run the simulation."""

from __future__ import annotations

import functools
from collections.abc import Callable
from math import inf
from typing import TYPE_CHECKING, Any, TypeVar

from turtle_lesson.ros.runtime.world import current_world, play
from turtle_lesson.ros.sim import run_blocking
from turtle_lesson.ros.sim.run_blocking import Call
from turtle_lesson.ros.sim.simulation import NANOSECONDS, NEVER
from turtle_lesson.ros.sim.strand import Strand, running_strand
from turtle_lesson.ros.stdlib.clocks import real_monotonic
from turtle_lesson.ros.stdlib.deadlock import wait_in_vain

from ._deadlock import executor_of_worker

if TYPE_CHECKING:
    from .context import Context
    from .executors import Executor

T = TypeVar("T")
SAY_AFTER = 5.0
"""Real time, s, after which a cell that spins says how to stop it."""


def drives_the_simulation(function: Callable[..., T]) -> Callable[..., T]:
    """Decorator for a blocking call: from a plain cell, it is run as part of the notebook's process until done."""

    @functools.wraps(function)
    def call(*arguments: Any, **keywords: Any) -> T:
        if running_strand() is not None:
            return function(*arguments, **keywords)
        return drive(function, *arguments, **keywords)

    return call


def drive(function: Callable[..., T], *arguments: Any, **keywords: Any) -> T:
    """Run the simulation until `function(*arguments, **keywords)`, as part of the notebook's process, is done."""
    return run_blocking.drive(current_world().notebook, function, *arguments, **keywords)


def spin_live(function: Callable[[], None]) -> None:
    """Run `function` in the notebook's process, with the simulation paced to the wall clock, until it returns.

    In a world that has an end nobody watches, and it goes as fast as possible.
    """
    world = current_world()
    simulation = world.sim
    if simulation.end != NEVER:
        run_blocking.drive(world.notebook, function, limit=simulation.end - simulation.now + 1)
        return
    simulation.check_it_can_run()
    call, say_at = Call(world.notebook, function), real_monotonic() + SAY_AFTER

    def done() -> bool:
        nonlocal say_at
        if real_monotonic() > say_at:
            say_at = inf
            print("This cell spins until you stop it: the ■ button above, or the key I twice.", flush=True)
        return call.done

    try:
        play(world, 1.0, done)
    except KeyboardInterrupt as interrupt:
        call.give_up(interrupt)
        raise call.error or interrupt from None
    finally:
        simulation.driven = None
    if call.error is not None:
        raise call.error


@drives_the_simulation
def wait_until(
    condition: Callable[[], bool], timeout_sec: float | None, every: int, context: Context, what: str
) -> bool:
    """Look every so often (ns) whether a condition holds; False if it does not within the timeout (s), or the context ends.

    None waits forever. As rclpy's own loops do, it waits for whole steps. `what` is what the running thread is said to do.
    """
    strand = running_strand()
    assert strand is not None
    strand.activity, simulation = what, strand.simulation
    try:
        patience = NEVER if timeout_sec is None else int(min(max(timeout_sec, 0.0) * NANOSECONDS, NEVER))
    except (TypeError, ValueError) as error:
        error.add_note(f"The timeout is a number of seconds, or None to wait forever; got {timeout_sec!r}.")
        raise
    deadline = simulation.now + patience
    while not condition():
        if not context.ok() or simulation.now >= deadline:
            return False
        simulation.sleep_until(simulation.now + every)
    return True


class WakeUp:
    """A one-shot wake-up: `wait` blocks the running strand until a time of the simulation, or until `wake` is called.

    A shutdown of its context calls `wake`, too.
    """

    def __init__(self, context: Context) -> None:
        strand = running_strand()
        assert strand is not None
        self.strand = strand
        self.woken = False
        self._context = context
        context.wake_on_shutdown(self.wake)

    def wake(self) -> None:
        """End the waiting."""
        self.woken = True
        self.strand.simulation.wake(self.strand)

    def wait(self, deadline: int | None, *, only_from_within: bool = True) -> None:
        """Wait until the deadline (ns of the simulation; None forever), or until `wake` is called.

        `only_from_within`: only another thread of this process can call `wake`.
        """
        strand = self.strand
        check = functools.partial(wait_in_vain, strand, "the next tick") if only_from_within else None
        try:
            strand.simulation.wait_for(strand, lambda: self.woken, deadline, check)
        finally:
            self._context.forget_wake(self.wake)


def somebody_spins(executor: Executor | None, strand: Strand) -> bool:
    """Whether another strand than this spins an executor, or may do so yet (in doubt: yes)."""
    if strand.process.is_notebook:
        return True
    if executor is not None and executor._spun_by_another(strand):
        return True
    others = (each for each in strand.process.strands if each is not strand and not each.dead)
    return any(executor_of_worker(each) is None for each in others)
