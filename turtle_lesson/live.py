"""Live mode: robot time goes on by itself, paced to the wall clock, while other cells can be run."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from .ros.core import NANOSECONDS
from .ros.core.tracebacks import print_error
from .ros.core.virtual_time import real_monotonic

if TYPE_CHECKING:
    from .ros.core import Simulation

STEP = 1 / 30
LONGEST_WORK = 0.1
"""How long a step may keep the notebook busy, in seconds; a rate that needs more is as fast as the computer can."""

LONGEST_STEP = 0.25
"""After a cell that computed for long, live mode does not rush to catch up: at most this many seconds a step."""


class Player:
    """Plays a simulation in the notebook's event loop."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._task: asyncio.Task[None] | None = None
        self.rate = 1.0

    @property
    def playing(self) -> bool:
        """Whether robot time goes on by itself."""
        return self._task is not None and not self._task.done()

    def play(self, rate: float) -> None:
        """Go on by itself at `rate` times real time; if it does so already, only change the rate."""
        if not isinstance(rate, (int, float)) or not 0 < rate < float("inf"):
            raise ValueError(
                f"rate must be a number above 0, got {rate!r}: 1.0 is as fast as life, 10 ten times faster"
            )
        self.rate = float(rate)
        if self.playing:
            return
        try:
            loop = asyncio.get_running_loop()
        except RuntimeError:
            raise RuntimeError(
                "play() needs a notebook, whose event loop goes on between cells; in a script use lesson.run(seconds)"
            ) from None
        self._task = loop.create_task(self._play())

    def pause(self) -> None:
        """Stop."""
        if self._task is not None:
            self._task.cancel()
            self._task = None

    async def _play(self) -> None:
        simulation = self._simulation
        last = real_monotonic()
        while not simulation.closed:
            await asyncio.sleep(STEP)
            now = real_monotonic()
            step = min(now - last, LONGEST_STEP) * self.rate
            last = now
            if simulation.closed:
                return
            try:
                self._run(simulation.now + round(step * NANOSECONDS))
            except KeyboardInterrupt:  # which would end Jupyter's event loop, and with it the kernel
                self._task = None
                print("Live mode was interrupted; lesson.play() goes on.")
                return
            except Exception as error:
                self._task = None
                print("Live mode has stopped, because of this; lesson.play() goes on.")
                print_error(error)
                return

    def _run(self, until: int) -> None:
        """Run towards `until` (ns), but at most for `LONGEST_WORK` of real time, so that cells stay usable at any rate."""
        simulation = self._simulation
        deadline = real_monotonic() + LONGEST_WORK
        while simulation.now < until and real_monotonic() < deadline:
            simulation.run_until(min(until, simulation.now + NANOSECONDS))
