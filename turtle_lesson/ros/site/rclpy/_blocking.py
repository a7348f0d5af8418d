"""Blocking calls work everywhere: in a simulated process they wait, in a plain notebook cell they run the simulation."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeVar

from turtle_lesson.ros.core import NANOSECONDS, driving, running_strand
from turtle_lesson.ros.core.driving import Call
from turtle_lesson.ros.core.virtual_time import real_monotonic, real_sleep
from turtle_lesson.ros.world import current_world

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
    return driving.drive(world.sim, world.notebook, function, *arguments, **keywords)


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
