"""While the simulation runs: Ctrl-C pauses it at a clean instant, and code that lets no time pass is found.

Jupyter's stop button and Ctrl-C send SIGINT. Python would raise KeyboardInterrupt wherever it happens to be, which is
in the middle of some simulated process, and kill that one alone. `Guard` asks the simulation to stop instead; the next
run goes on from there. A process that computes without end is frozen in the middle of its computation.
"""

from __future__ import annotations

import _thread
import signal
import sys
import threading
import time
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import TYPE_CHECKING, Any

from .careful import loop_aside
from .errors import NeverReturns
from .strand import Strand, running_strand
from .tracebacks import is_learners, is_library, is_ours

if TYPE_CHECKING:
    from .simulation import Simulation

JUPYTER = {"IPython", "comm", "debugpy", "ipykernel", "jupyter_client", "tornado", "traitlets", "zmq"}
"""The packages that Jupyter's kernel is made of."""

_monotonic = time.monotonic  # the real one, whatever time.monotonic becomes

patience = 10.0
"""How many seconds of CPU time a callback may compute while the virtual clock stands still.

The wall clock would make it a matter of what else the machine has to do. It only counts for a callback that does not
compute at all, but waits for something outside the simulation.
"""

BLOCKED = 0.02
"""A thread that gets less CPU time than this share of the wall clock's waits for something."""

interrupt_patience = 1.0
"""How long after Ctrl-C, in seconds of real time, a computing callback is waited for before it is frozen."""


class Guard:
    """Watches one run of a simulation: `with Guard(simulation): …`, then `raise_if_interrupted()`."""

    def __init__(self, simulation: Simulation) -> None:
        self.simulation = simulation
        self.interrupted = False
        self.tripped_at: int | None = None
        self.spent = False
        self._previous: Any = None
        self._outer: Guard | None = None
        self._active = threading.current_thread() is threading.main_thread()

    def __enter__(self) -> Guard:
        if self._active:
            self._previous = signal.signal(signal.SIGINT, self._on_signal)
            self._outer = _watchdog.watch(self)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._active:
            _watchdog.watch(self._outer)
            if self._previous is not None:
                signal.signal(signal.SIGINT, self._previous)

    def raise_if_interrupted(self) -> None:
        """Raise KeyboardInterrupt in the cell if the user asked for it while the simulation ran."""
        if self.interrupted:
            raise KeyboardInterrupt

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        tripped, self.tripped_at = self.tripped_at, None
        spent, self.spent = self.spent, False
        if spent:
            call, self.simulation.suspect = self.simulation.suspect, _learners_call(frame)
            if call is not None and call is self.simulation.suspect:  # the same call is still not done
                self._give_up_on(running_strand(), "has computed for very long in the little time that passed")
        elif tripped is None:
            self.interrupted = True
            self.simulation.halt()
            if _asks_the_user(frame):  # as Ctrl-C at a terminal's prompt: nothing else would end the question
                raise KeyboardInterrupt
        elif tripped == self.simulation.now and not _jupyter_is_at_work(frame):  # else time has passed since it looked
            strand = running_strand()
            if self.interrupted:
                self._freeze(strand)
            else:
                self._give_up_on(strand, f"has computed or blocked for {patience:g} s without letting any time pass")

    def _freeze(self, strand: Strand | None) -> None:
        """Leave the strand in the middle of what it computes; the next run goes on there."""
        if strand is None:
            raise KeyboardInterrupt  # it is no process that computes, but what the cell itself does
        self.simulation.put_back(strand)
        with loop_aside():
            self.simulation.hub.switch()

    def _give_up_on(self, strand: Strand | None, reason: str) -> None:
        name = "what the cell does" if strand is None else strand.process.name
        if strand is not None and strand.warned:
            strand.process.abandon("it computes without end and ignores being told to stop")
            self.simulation.hub.switch()
        if strand is not None:
            strand.warned = True
        raise NeverReturns(
            f"{name} {reason}, so nothing else in this world could happen. A callback should do a little and return; "
            "let a timer call it again. To wait inside a loop, call time.sleep(seconds); to wait for another callback, "
            "await a future."
        )


def _jupyter_is_at_work(frame: FrameType | None) -> bool:
    """Whether code of Jupyter's was called here, as by a print. It may hold a lock that Jupyter's threads wait for."""
    while frame is not None:
        name = frame.f_globals.get("__name__", "").partition(".")[0]
        if name in JUPYTER:
            return True
        file = frame.f_code.co_filename
        if is_ours(file) or not is_library(file):
            return False
        frame = frame.f_back
    return False


def _learners_call(frame: FrameType | None) -> FrameType | None:
    """The call of a learner's function that goes on here, the outermost since an executor or Jupyter called; or None."""
    call = None
    while frame is not None:
        name = frame.f_globals.get("__name__", "")
        if name.startswith("rclpy._executor") or name.partition(".")[0] in JUPYTER:
            break
        if is_learners(frame.f_code.co_filename):
            call = frame
        frame = frame.f_back
    return call


class _Watchdog:
    """A thread that looks, a few times a second, whether the guarded simulation's clock still moves."""

    def __init__(self) -> None:
        self._guard: Guard | None = None
        self._wanted = threading.Event()
        self._thread: threading.Thread | None = None

    def watch(self, guard: Guard | None) -> Guard | None:
        """Watch this guard's run from now on, or none. Returns the guard that was watched before."""
        before, self._guard = self._guard, guard
        if guard is None:
            self._wanted.clear()
            return before
        if self._thread is None or not self._thread.is_alive():
            self._thread = threading.Thread(target=self._loop, name="turtle_lesson watchdog", daemon=True)
            self._thread.start()
        self._wanted.set()
        return before

    def _loop(self) -> None:
        seen: tuple[object, int] | None = None
        since, computed = _monotonic(), work_done()
        while True:
            self._wanted.wait()
            guard = self._guard
            if guard is not None:
                state = (guard, guard.simulation.now)
                waited, work = _monotonic() - since, work_done() - computed
                if state != seen:
                    seen, since, computed = state, _monotonic(), work_done()
                elif _being_debugged():
                    since, computed = _monotonic(), work_done()
                elif _is_too_much(waited, work, guard.interrupted):
                    since, computed = _monotonic(), work_done()
                    guard.tripped_at = guard.simulation.now
                    _interrupt_main_thread()
                until = guard.simulation.work_until
                if until is not None and work_done() > until:
                    guard.spent = True
                    _interrupt_main_thread()
            _sleep(min(0.25, patience / 4, interrupt_patience / 4))


def _is_too_much(waited: float, work: float, interrupted: bool) -> bool:
    """Whether the clock has stood still for too long: seconds by the wall clock, and of CPU time of the main thread."""
    if interrupted:
        return waited > interrupt_patience
    return work > patience or (waited > patience and work < BLOCKED * waited)


def work_done() -> float:
    """The CPU time, in s, of the main thread; of the whole process where the system does not tell threads apart."""
    if not hasattr(time, "pthread_getcpuclockid"):
        return time.process_time()
    return time.clock_gettime(time.pthread_getcpuclockid(threading.main_thread().ident or 0))


def _interrupt_main_thread() -> None:
    """Have the main thread run its signal handler, also if it waits for a lock (where the system can do that)."""
    main = threading.main_thread().ident
    if main is not None and hasattr(signal, "pthread_kill"):
        signal.pthread_kill(main, signal.SIGINT)
    else:
        _thread.interrupt_main()


_sleep = time.sleep
_watchdog = _Watchdog()


def _being_debugged() -> bool:
    """Whether the main thread waits for its user: in a debugger, or in input()."""
    frame = sys._current_frames().get(threading.main_thread().ident or 0)
    return _asks_the_user(frame) or _is_within(frame, lambda each: each.f_globals.get("__name__") in _DEBUGGERS)


def _asks_the_user(frame: FrameType | None) -> bool:
    """Whether this is within Jupyter's input(), or within the one of a program in a script."""
    return _is_within(frame, lambda each: each.f_code.co_name in _ASKING)


def _is_within(frame: FrameType | None, is_it: Callable[[FrameType], bool]) -> bool:
    while frame is not None:
        if is_it(frame):
            return True
        frame = frame.f_back
    return False


_DEBUGGERS = {"bdb", "pdb", "IPython.core.debugger"}
_ASKING = {"raw_input", "_input_request", "_answer_of_the_cell"}
