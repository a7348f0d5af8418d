"""Blocking calls work everywhere: in a simulated process they wait, in a plain notebook cell they run the simulation."""

from __future__ import annotations

import asyncio
import functools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from turtle_lesson.ros.runtime.world import current_world
from turtle_lesson.ros.sim import run_blocking
from turtle_lesson.ros.sim.run_blocking import Call
from turtle_lesson.ros.sim.simulation import NANOSECONDS
from turtle_lesson.ros.sim.strand import running_strand
from turtle_lesson.ros.stdlib.clocks import real_monotonic, real_sleep

if TYPE_CHECKING:
    from .task import Future


# -- blocking -----------------------------------------------------------------------------------------------------
# Blocking calls work everywhere: in a simulated process they wait, in a plain notebook cell they run the simulation.

T = TypeVar("T")
LIVE_STEP = 0.02
SAY_AFTER = 5.0
"""Real time, s, after which a cell that spins says how to stop it."""


def in_a_plain_cell() -> bool:
    """Whether the running code is no simulated process (a notebook cell, a test, a script)."""
    return running_strand() is None


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
    world = current_world()
    return run_blocking.drive(world.sim, world.notebook, function, *arguments, **keywords)


def spin_live(function: Callable[[], None]) -> None:
    """Run `function` in the notebook's process, with the simulation paced to the wall clock, until it returns."""
    world = current_world()
    simulation = world.sim
    simulation.check_it_can_run()
    call = Call(simulation, world.notebook, function)
    try:
        began, origin, told = real_monotonic(), simulation.now, False
        while not call.done:
            elapsed = round((real_monotonic() - began) * NANOSECONDS)
            if elapsed > SAY_AFTER * NANOSECONDS and not told:
                told = True
                print("This cell spins until you stop it: the ■ button above, or the key I twice.", flush=True)
            simulation.run_until(max(simulation.now, origin + elapsed))
            real_sleep(LIVE_STEP)
    except KeyboardInterrupt as interrupt:
        call.give_up(interrupt)
        raise call.error or interrupt from None
    finally:
        simulation.driven = None
    if call.error is not None:
        raise call.error


# -- asyncio ------------------------------------------------------------------------------------------------------
# Futures of rclpy's in asyncio's coroutines: a program may await them there, and call `rclpy.spin_once` beside that.
# The real ones are asked in every round of the loop whether they are done; those here tell the loop.

FOR_ALL = object()
"""Stands for a future that is cancelled for good, not only for one of asyncio's coroutines."""


def refuse_in_a_cell() -> None:
    """Raise RuntimeError in a coroutine of the notebook's own loop: while that one waits, no robot time passes."""
    if running_strand() is None and asyncio._get_running_loop() is not None:
        raise RuntimeError(
            "a future of rclpy's cannot be awaited in a cell: no robot time would pass meanwhile. Write "
            "rclpy.spin_until_future_complete(node, future), then future.result()."
        )


def called_by_its_loop(callback: Callable[..., Any], context: Any) -> Callable[[Future], None]:
    """A done callback of asyncio's, to be called by the loop that runs now."""
    loop = asyncio.get_running_loop()

    def call(future: Future) -> None:
        loop.call_soon_threadsafe(callback, future, context=context)

    call._at_once = call._of_asyncio = True  # type: ignore[attr-defined]
    return call


def let_asyncio_go_on(future: Future) -> bool:
    """Wake the coroutines of asyncio's that await a future: one of them is cancelled, the others wait on."""
    callbacks = [each for each in future._callbacks if getattr(each, "_of_asyncio", False)]
    for callback in callbacks:
        future._callbacks.remove(callback)
        callback(future)
    return False
