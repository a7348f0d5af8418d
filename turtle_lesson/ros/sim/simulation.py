"""The simulation: one clock in whole nanoseconds, one heap of timed events, one queue of strands that are due now.

What makes it deterministic is the heap's key: time, then a counter, so that events of the same instant happen in the
order in which they were asked for. All events of an instant happen first; then the strands that they woke go on, one
after the other, in the order in which they were woken.
"""

from __future__ import annotations

import asyncio
import gc
import sys
import weakref
from _thread import get_ident
from collections import deque
from collections.abc import Callable
from contextlib import nullcontext, suppress
from contextvars import copy_context
from heapq import heappop, heappush
from types import FrameType
from typing import TYPE_CHECKING, Any

from greenlet import GreenletExit

from .errors import OutOfTime, SimulationError, WorldClosed
from .interrupts import Guard
from .keyboard import Keyboard
from .strand import PATIENCE, Carrier, Cell, Face, LoopAside, Strand, running_greenlet, running_strand, undead

if TYPE_CHECKING:
    from .stepped_call import SteppedCall

NANOSECONDS = 1_000_000_000
EPOCH = 1_800_000_000 * NANOSECONDS
"""What the virtual wall clock (`time.time()`) shows when a world starts, in ns since 1970: 2027-01-15 08:00 UTC."""

CLOCK_READ = 1_000
"""What reading the clock costs in virtual time, in ns, so that a loop that only looks at the clock comes to an end."""

NEVER = 2**63
"""A virtual time (ns) that is not reached."""


class Simulation(Face):
    """Runs timed events and strands in order. `now` is the virtual time in ns since the world's start."""

    def __init__(self) -> None:
        super().__init__()
        self.now = 0
        self.hub = running_greenlet()
        self.running = False
        self.closed = False
        self._heap: list[tuple[int, int, Callable[[Any], object], Any]] = []
        self._ready: deque[Strand] = deque()
        self.make_ready = self._ready.append
        """Queue a strand that is parked no longer; `wake` does it with all care."""
        self.events = 0
        """How many were ever asked for."""
        self.looks = 0
        self.looked_at = 0
        self._limit = 0
        self.halted = False
        """Whether the last run was ended before its time, by `halt`."""
        self._raising = False
        self.end = NEVER
        """The virtual time (ns) that no run may pass: it ends there with OutOfTime."""
        self.thread = get_ident()
        self.work_until: float | None = None
        """The CPU time of the main thread (s) after which a learner's call that goes on is stopped; None: it may go on."""
        self.suspect: FrameType | None = None
        """The call that went on when that was last looked at."""
        self.driven: Strand | None = None
        self.stepped: SteppedCall | None = None
        """A function that runs the simulation and is itself run step by step."""
        self._cell = Cell(copy_context())
        self._for_the_hub: deque[tuple[Callable[..., object], tuple[Any, ...]]] = deque()
        self.strands: weakref.WeakSet[Strand] = weakref.WeakSet()
        self._forgotten: list[Strand] = []
        self._carriers: list[Carrier] = []
        self._idle_carriers: list[Carrier] = []
        self.keyboard = Keyboard(self)

    # -- asking for things to happen -------------------------------------------------------------------------

    def at(self, time: int, action: Callable[[Any], object], argument: Any) -> None:
        """Have `action(argument)` called at virtual time `time` (ns), by the strand that waits then.

        It must be short and may only wake strands; what does more is given to `call_later`.
        """
        self.events = count = self.events + 1
        heappush(self._heap, (time, count, action, argument))

    def call_later(self, delay: int, action: Callable[..., object], *arguments: Any) -> None:
        """Have `action(*arguments)` called `delay` ns from now, in the cell that runs the simulation then."""
        if delay < 0:
            raise SimulationError(f"cannot call {action!r} in the past: the delay is {delay} ns; give 0 or more")
        self.at(self.now + delay, self._for_the_hub.append, (action, arguments))

    def wake(self, strand: Strand) -> None:
        """Let a parked strand go on at this instant. Waking one that is not parked does nothing."""
        if strand.parked:
            strand.parked = False
            self._ready.append(strand)

    def put_back(self, strand: Strand) -> None:
        """Have a strand that was stopped in its middle go on first, in the next run."""
        self._ready.appendleft(strand)

    def forget(self, strand: Strand) -> None:
        """Never run a strand again. What it holds is given back when the world closes."""
        strand.parked = False
        strand.waits_for = "nothing"
        self._forgotten.append(strand)
        if strand in self._ready:
            self._ready.remove(strand)

    # -- what a strand may do --------------------------------------------------------------------------------

    def sleep_until(self, time: int) -> None:
        """Hold up the running strand until virtual time `time` (ns)."""
        heap = self._heap
        if not self._ready and time < self._limit and not self._for_the_hub and (not heap or heap[0][0] > time):
            if time > self.now:
                self.now = time  # nobody else has anything to do until then: no need to switch
            return
        strand = running_strand()
        if strand is None:
            raise SimulationError(
                "only a simulated process can sleep in virtual time; in a cell use lesson.run(seconds)"
            )
        self.at(time, self.wake, strand)
        self.park(strand)
        while self.now < time:
            self.park(strand)

    def wait_for(
        self,
        strand: Strand,
        condition: Callable[[], object],
        deadline: int | None = None,
        check: Callable[[], None] | None = None,
    ) -> bool:
        """Hold up the running strand until a condition holds, or until `deadline` (ns); whether it holds.

        What has it hold wakes the strand. Without a deadline `check` is called first: it raises an error if it is in vain.
        """
        if deadline is not None and self.now < deadline:
            self.at(deadline, self.wake, strand)
        try:
            while not condition():
                if deadline is not None and self.now >= deadline:
                    return False
                if deadline is None and check is not None:
                    check()
                self.park(strand)
            return True
        finally:
            strand.waits_for = None

    def read_clock(self, cost: int = CLOCK_READ) -> int:
        """The virtual time in ns, for a caller that reads a clock: reading costs time itself (ns)."""
        if self._raising:
            return self.now  # somebody who was interrupted cleans up, all in this instant
        if gc.callbacks and _collects_garbage():
            return self.now  # a library measures a collection, which comes at any time and takes no virtual time
        if running_strand() is not None:
            self.sleep_until(self.now + cost)
        elif not self.running and not self.closed:
            self.run_until(self.now + cost)
        return self.now

    # -- running ---------------------------------------------------------------------------------------------

    def run_until(self, time: int) -> None:
        """Run everything that happens before `time` (ns; half-open, so an event at `time` waits for the next run).

        Raises KeyboardInterrupt at a clean instant when the user interrupts; the next run goes on from there.
        """
        if time < self.now:
            raise SimulationError(f"cannot run back in time: it is {self.now} ns, asked for {time} ns")
        with Guard(self):
            self.check_it_can_run()
            self.run_guarded(time, time_passes=True)

    def settle(self) -> None:
        """Let everything happen that is due at this instant, without letting time pass."""
        with Guard(self):
            self.check_it_can_run()
            self.run_guarded(self.now + 1)

    def raise_in(self, strand: Strand, error: BaseException) -> None:
        """Raise `error` where a strand waits, at once, and let it clean up until it waits again or ends."""
        if not strand.dead:
            self._visit(strand, lambda: strand.own_body().throw(error))

    def call_in(self, strand: Strand, function: Callable[[], object]) -> None:
        """Call a function within a strand, where it waits, at once. The strand must have been made careful before."""
        if not strand.dead:
            strand.calls = [*strand.calls, function]
            self._visit(strand, lambda: strand.own_body().switch())

    def _visit(self, strand: Strand, go: Callable[[], object]) -> None:
        """Switch to a strand out of its turn, until it waits again or ends. No time passes.

        An interrupt meanwhile, which would leave this half done, is raised at the end.
        """
        with nullcontext() if self.running else Guard(self):
            hub, face, halted, limit, raising = self.hub, self._face, self.halted, self._limit, self._raising
            self.hub = running_greenlet()
            self.halt()
            self._raising = True
            self._enter(strand.process)
            try:
                if running_strand() is None:
                    self._cell = self._cell.now()
                if strand.cell is not self._cell:
                    self._cell.show_to(strand)
                with LoopAside():
                    go()
            finally:
                self.hub, self.halted, self._limit, self._raising = hub, halted, limit, raising
                if strand.dead and strand in self._ready:
                    self._ready.remove(strand)
                self._leave()
                if face is not None:
                    self._enter(face)

    def check_it_can_run(self) -> None:
        """Raise WorldClosed or SimulationError where a run is not possible."""
        if self.closed:
            raise WorldClosed("this world was closed by a later start(): use the lesson that start() returned last")
        if self.running:
            raise SimulationError("the simulation runs already: a callback cannot run it once more")
        if get_ident() != self.thread:
            raise SimulationError(
                "a world runs in the thread that made it, and in no other: hand the work over to that one, for example "
                "with loop.call_soon_threadsafe"
            )

    def run_guarded(self, limit: int, *, time_passes: bool = False) -> None:
        """Run everything before `limit` (ns), and let it be `limit` then if time passes by itself.

        The caller holds a Guard, so that no interrupt can come in between.
        """
        if self.stepped is None:
            self.run_events(limit, time_passes)
        else:
            self.stepped.run(limit, time_passes)

    def run_events(self, limit: int, time_passes: bool) -> None:
        """What `run_guarded` does where nothing is run step by step."""
        hub = running_greenlet()
        if hub is not self.hub:  # strands and carriers end where their parent goes on: there, too
            self.hub = hub
            for each in self._greenlets():
                if not each.dead:
                    each.parent = hub
        self._limit = min(limit, self.end)
        self.halted = False
        self.running = True
        with LoopAside():  # a simulated process is no part of Jupyter's event loop
            try:
                self._loop()
            finally:
                self.running = False
                self._limit = 0
                self._leave()
        if not self.halted and (time_passes or self._heap):
            self.check_end(limit)
        if time_passes and not self.halted:
            self.now = limit

    def check_end(self, time: int) -> None:
        """Raise OutOfTime at the world's end if it was to run until `time` (ns)."""
        if time > self.end:
            self.now = self.end
            raise OutOfTime(f"its world ended, at {self.end / NANOSECONDS:g} s of robot time")

    def scheduled(self) -> list[tuple[int, int, Callable[[Any], object], Any]]:
        """What `at` was asked for and has not happened yet, in its order: time (ns), a number, action, argument."""
        return sorted(self._heap, key=lambda event: event[:2])

    @property
    def next_event(self) -> int:
        """When the next event happens (virtual time, ns), as far as is known now; NEVER if there is none."""
        return self._heap[0][0] if self._heap else NEVER

    def show_cell_to(self, line: Any) -> None:
        """Have a greenlet that is about to go on print to the cell that runs now."""
        self._cell = self._cell.now()
        self._cell.show_to(line)

    def call_done(self, strand: Strand) -> None:
        """A blocking call has returned: what waits for it goes on."""
        if self.stepped is not None:
            self.stepped.call_done(strand)
        if self.driven is strand:
            self.halt()

    def _loop(self) -> None:
        """What the hub does: let strands go on until nothing is left to do, or the run is halted."""
        self._cell = self._cell.now()
        while True:
            strand = self._next_strand()
            if strand is not None:
                if strand.body is None and not self._idle_carriers:
                    carrier = Carrier(self._carry)
                    carrier.parent = self.hub
                    self._carriers.append(carrier)
                    self._idle_carriers.append(carrier)
                self._go_on_with(strand)
            elif self._for_the_hub:
                self._leave()
                action, arguments = self._for_the_hub.popleft()
                action(*arguments)
            else:
                return

    def _next_strand(self) -> Strand | None:
        """Let time pass until a strand is due, and return it; None if the hub has to decide what happens now."""
        heap, ready = self._heap, self._ready
        while not self.halted:
            if ready:
                return ready.popleft()
            if self._for_the_hub or not heap or heap[0][0] >= self._limit:
                return None
            now, _, action, argument = heappop(heap)
            self.now = now
            action(argument)
            while heap and heap[0][0] == now:
                _, _, action, argument = heappop(heap)
                action(argument)
        return None

    def _go_on_with(self, strand: Strand) -> None:
        if strand.body is None:
            self._ready.appendleft(strand)
            self._idle_carriers.pop().switch()
            return
        if strand.process is not self._face:
            self._enter(strand.process)
        if strand.cell is not self._cell:
            self._cell.show_to(strand)  # or what it prints would go to an earlier cell
        strand.body.switch()

    def park(self, strand: Strand) -> None:
        """Stop the running strand until it is woken, or now and then for nothing: callers look in a loop.

        The strand itself looks for who goes on, and hands over; the hub is only asked if nobody does. So a switch
        goes straight from one process to the next, and a process that waits for its own timer does not switch at all.
        """
        strand.parked = True
        following = self._next_strand()
        if following is not strand:
            self._hand_over_to(following)
        if strand.body is None:
            strand.body = strand  # it goes on itself, and not in a turn

    def _hand_over_to(self, strand: Strand | None) -> None:
        """Have another strand go on, or the hub decide what happens now."""
        if strand and (strand.body is not None or self._idle_carriers):
            self._go_on_with(strand)
            return
        if strand is not None:  # what begins here, it or a carrier, would count the calls on this stack as its own
            self._ready.appendleft(strand)
        self.hub.switch()

    # -- turns -----------------------------------------------------------------------------------------------

    def take_turns(self, strand: Strand, turn: Callable[[], bool]) -> None:
        """Call `turn()` now and each time that the strand is woken, until it returns False.

        What it raises is raised here.
        """
        if not self._may_hand_turns_over(strand):
            while turn():
                self.park(strand)
            return
        while turn():
            strand.turn, strand.context, strand.body = turn, strand.gr_context, None
            self.park(strand)
            if strand.turn is None:  # a carrier has taken the last one
                failure, strand.failure = strand.failure, None
                if failure is not None:
                    raise failure
                return

    def _may_hand_turns_over(self, strand: Strand) -> bool:
        """Not if the stack is a carrier's, which has calls of its own that wait for this strand."""
        return strand is running_greenlet()

    def _carry(self) -> None:
        """What a carrier does: take the turns of strands, one after the other, in the order in which they were woken."""
        carrier: Any = running_greenlet()
        ready = self._ready
        while True:
            strand = ready.popleft() if ready and not self.halted else self._next_strand()
            if strand is None or strand.body is not None:
                carrier.strand = None
                self._idle_carriers.append(carrier)
                self._hand_over_to(strand)
                continue
            if strand is not carrier.strand:
                if strand.process is not self._face:
                    self._enter(strand.process)
                if strand.cell is not self._cell:
                    self._cell.show_to(strand)
                carrier.strand = strand
                carrier.gr_context = strand.context
            strand.body = carrier
            turn = strand.turn
            try:
                waits = turn()
            except BaseException as error:
                strand.failure, waits = error, False
            if waits:
                strand.body = None
                strand.parked = True
            else:
                strand.body, strand.turn = strand, None
                carrier.strand = None
                self._idle_carriers.append(carrier)
                self._go_on_with(strand)

    def halt(self) -> None:
        """Stop the loop as soon as the running strand lets go, even if it only looks at the clock in a loop."""
        self.halted = True
        self._limit = 0

    def _greenlets(self) -> list[Strand | Carrier]:
        return [*self.strands, *self._carriers]

    # -- the end ----------------------------------------------------------------------------------------------

    def close(self) -> None:
        """End the simulation for good: nothing of it runs again, and what stands somewhere in a call is unwound."""
        self.closed = True
        with suppress(KeyboardInterrupt), Guard(self):
            for strand in list(self.strands):
                for _ in range(PATIENCE):
                    if strand and not strand.dead and not strand.warned:
                        with suppress(BaseException):  # whatever it says now, nobody is there to hear it
                            self.raise_in(strand, GreenletExit())
        for carrier in self._idle_carriers:
            carrier.parent = running_greenlet()
            carrier.throw(GreenletExit)
        undead.extend(each for each in self._greenlets() if each and not each.dead)
        self._heap.clear()
        self._ready.clear()


class CarefulSimulation(Simulation):
    """A simulation in which a program uses asyncio or handles signals.

    A strand takes the note of the asyncio loop that runs along when it parks, and a handler of a signal is called where the
    process waits. Both would slow every switch, so a simulation becomes one of these when it is first needed.
    """

    def park(self, strand: Strand) -> None:
        """See Simulation."""
        if asyncio._get_running_loop() is None:
            super().park(strand)
        else:
            with LoopAside():
                super().park(strand)
        while strand.calls:
            function, *strand.calls = strand.calls
            function()

    def _may_hand_turns_over(self, strand: Strand) -> bool:
        """See Simulation. Nor within an asyncio loop, which would be missing on another stack."""
        return asyncio._get_running_loop() is None and super()._may_hand_turns_over(strand)


def be_careful(simulation: Simulation) -> None:
    """Let all strands of a simulation park with care from now on."""
    simulation.__class__ = CarefulSimulation


def _collects_garbage() -> bool:
    """Whether the caller is one of the functions that Python calls at each garbage collection (`gc.callbacks`)."""
    codes = {getattr(callback, "__code__", None) for callback in gc.callbacks}
    frame = sys._getframe(2)
    while frame is not None and frame.f_code not in codes:
        frame = frame.f_back  # type: ignore[assignment]
    return frame is not None
