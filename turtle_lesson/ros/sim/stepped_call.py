"""A function that runs the simulation, as a cell does, and is itself run step by step.

`lesson.run(60)` in a function lasts for a minute of robot time. To stop in the middle of that minute, the function gets a
greenlet of its own, and its runs are requests: "until then", or "until this call has returned". The caller of `go_on` carries
them out in pieces, and hands control back to the function exactly where a request is met. Since a run that is split changes no
event, the function and the world see the same as without steps.

Whatever else runs the simulation meanwhile (another cell, live mode, a button of a widget) steps the function in the same way.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Any

from . import interrupts
from .errors import WorldClosed
from .interrupts import Guard
from .simulation import NEVER, Simulation
from .strand import PATIENCE, GreenletExit, LoopAside, Strand, greenlet, running_greenlet, undead

STREAMS = ("argv", "stdout", "stderr")
"""What of `sys` the function may have replaced for a while, as `contextlib.redirect_stdout` does."""


class SteppedCall:
    """A call of `function`, which has not begun yet. There is one at a time in a simulation.

    `around` makes what surrounds each of its pieces, and what the world does meanwhile: it sets what the function should find,
    and puts it back for the caller.

    Attributes:
        done: whether it has returned or raised.
        value, error: what it returned, or what it raised.
    """

    def __init__(
        self,
        simulation: Simulation,
        function: Callable[[], Any],
        around: Callable[[], AbstractContextManager[object]] = nullcontext,
    ) -> None:
        self.simulation = simulation
        self.function = function
        self.done = False
        self.value: Any = None
        self.error: BaseException | None = None
        self._around = around
        self._greenlet: Any = greenlet(self._call)
        self._waits = False  # it has asked for a run …
        self._met = False  # … and that is over, or the call for whose sake it was has returned
        self._limit = 0
        self._out_of_time = False  # the world ends before that limit
        self._passes = False
        self._driven: Strand | None = None
        self._streams: dict[str, Any] = {}
        self._refusals: int | None = None
        simulation.stepped = self

    @property
    def runs_here(self) -> bool:
        """Whether the code that asks is the function, or was called by it."""
        return running_greenlet() is self._greenlet

    @property
    def computes(self) -> bool:
        """Whether the function's own code is running, and not the simulation."""
        return bool(self._greenlet) and not self._waits

    def _call(self) -> None:
        try:
            self.value = self.function()
        except BaseException as error:
            self.error = error
        self.done = True
        if self.simulation.stepped is self:
            self.simulation.stepped = None

    # -- what the simulation asks ------------------------------------------------------------------------------------

    def run(self, limit: int, time_passes: bool) -> None:
        """Carry out `Simulation.run_guarded`: of the function, by asking for it; of anybody else, by stepping the function."""
        if self.runs_here:
            self._ask(limit, time_passes)
        elif not self._greenlet and limit <= self.simulation.now + 1:
            self.simulation.run_events(limit, time_passes)  # a widget settles: that is no reason to begin
        else:
            self._step(limit, time_passes)

    def call_done(self, strand: Strand) -> None:
        """A blocking call has returned; if it is the one that the function waits for, its request is met."""
        if strand is self._driven and self._waits:
            self._met, self._out_of_time = True, False  # a call may wait beyond the world's end, and return before
            self.simulation.halt()

    def go_on(self, until: int) -> None:
        """Let the function go on until `until` (ns), or to its end if that comes first.

        Raises KeyboardInterrupt when the user interrupts; the next step goes on from there, unless it was the function's own
        code that had to be interrupted: then that has got it, and is done as a rule.
        """
        with Guard(self.simulation):
            self.simulation.check_it_can_run()
            if not self.done:
                self._step(until, True, only_to_its_end=True)

    def close(self) -> None:
        """End the function, since its world is closed: its `finally` blocks run, but the world does not."""
        self._refusals = 0
        for _ in range(PATIENCE):
            if self._greenlet and not self.runs_here:
                with self._surroundings():
                    self._waits = False
                    self._greenlet.parent = running_greenlet()
                    self._greenlet.throw(GreenletExit)
        if self._greenlet and not self.runs_here:
            undead.append(self._greenlet)
        if self.simulation.stepped is self:
            self.simulation.stepped = None

    # -- both sides ----------------------------------------------------------------------------------------------------

    def _ask(self, limit: int, time_passes: bool) -> None:
        """In the function: have the simulation run until `limit` (ns), or until a call has returned."""
        if self._refusals is not None and self._refusals < PATIENCE:
            self._refusals += 1
            raise WorldClosed("this world was closed by a later start(): what ran step by step in it has ended")
        self._limit, self._passes, self._waits, self._out_of_time = limit, time_passes, True, False
        while self._waits:  # a strand that ends may come by here
            self._greenlet.parent.switch()
        if self._out_of_time:
            self.simulation.check_end(limit)

    def _step(self, limit: int, time_passes: bool, only_to_its_end: bool = False) -> None:
        """Run the simulation until `limit`, and the function where its requests are met."""
        simulation, driven = self.simulation, self.simulation.driven
        with self._surroundings(), LoopAside():
            while True:
                if not self._waits or self._met:
                    self._switch(driven)
                    if interrupts.watchdog.interrupted or (self.done and only_to_its_end):
                        return
                if self.done:
                    simulation.run_events(limit, time_passes)
                    return
                until = min(limit, self._limit, simulation.end)
                simulation.run_events(until, False)
                if interrupts.watchdog.interrupted:
                    return
                self._met = self._met or self._is_met(until)
                if not self._met:
                    if time_passes and not simulation.halted:
                        simulation.now = limit
                    return

    def _is_met(self, until: int) -> bool:
        """Whether what the function asked for has happened, now that the simulation has run until `until` (ns)."""
        simulation = self.simulation
        if simulation.halted:
            return False
        if self._limit > simulation.end and (self._passes or simulation.next_event < NEVER):
            self._out_of_time = until == simulation.end
            return self._out_of_time
        if not self._passes:
            return simulation.next_event >= self._limit
        if until < self._limit:
            return False
        simulation.now = until
        return True

    def _switch(self, driven: Strand | None) -> None:
        """Let the function's own code go on until it asks for the next run, or ends. `driven` is the caller's own call."""
        simulation = self.simulation
        self._waits = self._met = False
        self._greenlet.parent = running_greenlet()
        simulation.show_cell_to(self._greenlet)
        simulation.driven = self._driven
        self._greenlet.switch()
        self._driven = None if self.done else simulation.driven
        simulation.driven = self._driven if driven is None else driven

    @contextmanager
    def _surroundings(self) -> Iterator[None]:
        """Within this block the function's streams hold, and what else surrounds it; after it, those of the caller."""
        with self._around():
            before, driven = {name: getattr(sys, name) for name in STREAMS}, self.simulation.driven
            vars(sys).update(self._streams)
            self.simulation.driven = self._driven if driven is None else driven
            try:
                yield
            finally:
                self.simulation.driven = driven
                self._streams = {name: getattr(sys, name) for name in STREAMS if getattr(sys, name) is not before[name]}
                vars(sys).update(before)
