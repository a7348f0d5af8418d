"""While the simulation runs: Ctrl-C pauses it at a clean instant, and code that lets no time pass is found.

Jupyter's stop button and Ctrl-C send SIGINT. Python would raise KeyboardInterrupt wherever it happens to be, which is
in the middle of some simulated process, and kill that one alone. `Guard` asks the simulation to stop instead; the next
run goes on from there. A process that computes without end is frozen in the middle of its computation; one that waits for
something outside the simulation, or is frozen a second time at the same instant, gets a KeyboardInterrupt.

A learner's code that computes for long while the virtual clock stands still gets NeverReturns. What counts is the CPU time
of the main thread, which runs the simulation: how busy the machine is makes no difference. Imports do not count. Code that
waits for something outside, and the lesson's own nodes, only cause a notice.
"""

from __future__ import annotations

import _thread
import os
import signal
import sys
import threading
import time
from itertools import takewhile
from types import FrameType
from typing import TYPE_CHECKING, Any

from .errors import NeverReturns, is_learners
from .strand import LoopAside, Strand, running_strand

if TYPE_CHECKING:
    from .simulation import Simulation

JUPYTER = {"IPython", "comm", "debugpy", "ipykernel", "jupyter_client", "tornado", "traitlets", "zmq"}
"""The packages that Jupyter's kernel is made of."""

_monotonic, _sleep = time.monotonic, time.sleep  # the real ones, whatever they become
_set_handler = getattr(sys.modules["_signal"], "signal", signal.signal)  # which looks up no names, as each run needs it
_signal_thread, _main_thread = getattr(signal, "pthread_kill", None), threading.main_thread()

patience = 10.0
"""How many seconds of CPU time a learner's callback may compute while the virtual clock stands still.

After as many seconds of real time, a callback that does not compute, but waits for something outside, causes a notice.
"""

WAITING = 0.02
"""A thread that gets less CPU time than this share of the wall clock's waits for something."""

interrupt_patience = 1.0
"""How long after Ctrl-C, in seconds of real time, a callback is waited for before it is frozen, or its wait is ended."""


class Guard:
    """Watches one run of a simulation, `with Guard(simulation): …`, and raises an interrupt at its end.

    Attributes:
        interrupted: whether the user has interrupted the run.
        tripped_at: the virtual time (ns) that has stood still for too long, until the main thread has looked into it.
        waiting: whether the main thread hardly computed meanwhile.
        spent: whether a learner's call has used up its CPU time.
        seen, since, computed: the clock's last new state, and the real time and CPU time (s) at which it was first seen.
    """

    waiting = spent = False
    tripped_at: int | None = None
    seen: tuple[int, bool] | None = None
    since = computed = 0.0

    def __init__(self, simulation: Simulation) -> None:
        self.simulation = simulation
        self.interrupted = False
        self._previous: Any = None
        self._outer: Guard | None = None
        stepped = simulation.stepped  # what is run step by step is guarded by the one that steps it
        self._active = _thread.get_ident() == _main_thread.ident and (stepped is None or not stepped.runs_here)

    def __enter__(self) -> Guard:
        if self._active:
            self._previous = _set_handler(signal.SIGINT, self._on_signal)
            self._outer = watchdog.watch(self)
        return self

    def __exit__(self, kind: object, error: object, trace: object) -> None:
        if self._active:
            watchdog.watch(self._outer)
            if self._previous is not None:
                _set_handler(signal.SIGINT, self._previous)
        if self.interrupted and not isinstance(error, KeyboardInterrupt):
            raise KeyboardInterrupt

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        tripped, self.tripped_at = self.tripped_at, None
        spent, self.spent = self.spent, False
        if spent:
            call, self.simulation.suspect = self.simulation.suspect, _learners_call(frame)
            if call is not None and call is self.simulation.suspect and not _must_go_on(frame):  # it is still not done
                self._give_up_on(running_strand(), "has computed for very long in the little time that passed")
        elif tripped is None:
            self.interrupted = True
            self.simulation.halt()
            if "question" in _kinds(frame):
                raise KeyboardInterrupt  # as Ctrl-C at a terminal's prompt: nothing else would end the question
        elif tripped == self.simulation.now and not _must_go_on(frame):  # the clock still stands still
            strand = running_strand()
            below = None if strand is None else strand.gr_frame  # where a turn is taken on another stack
            kinds = [*_kinds(frame), *_kinds(below)]
            if self.interrupted:
                self._stop(strand, kinds)
            elif self.waiting or "learner" not in kinds:
                self._say_that_it_goes_on(strand)
            else:
                self._give_up_on(strand, f"has computed for {patience:g} s without letting any time pass")

    def _stop(self, strand: Strand | None, kinds: list[str]) -> None:
        """Have the run end: leave the strand in the middle of what it computes, for the next run; or end a learner's code."""
        now = self.simulation.now
        if strand is None:
            raise KeyboardInterrupt  # it is no process that computes, but what the cell itself does
        if "learner" in kinds and (self.waiting or strand.frozen_at == now or "import" in kinds):
            raise KeyboardInterrupt  # a module that is frozen half imported could have other threads wait for its lock
        strand.frozen_at = now
        self.simulation.put_back(strand)
        with LoopAside():
            self.simulation.hub.switch()

    def _say_that_it_goes_on(self, strand: Strand | None) -> None:
        """Print a notice, once for each process."""
        if strand is None or strand.process.noticed:
            return
        strand.process.noticed = True
        what = "waiting for something outside the simulation (a socket, a file, another program)"
        print(
            f"{strand.process.name} has been {what if self.waiting else 'computing'} for {patience:g} s. Robot time stands "
            "still until that is over; the stop button (Ctrl-C) interrupts it.",
            file=sys.stderr,
        )

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


class Watchdog:
    """A thread that looks, a few times a second, whether the guarded simulation's clock still moves."""

    def __init__(self) -> None:
        self._guard: Guard | None = None
        self._change = threading.RLock()  # or the main thread could be interrupted when its run is over
        self._wanted = threading.Event()
        self._thread: threading.Thread | None = None

    def watch(self, guard: Guard | None) -> Guard | None:
        """Watch this guard's run from now on, or none. Returns the guard that was watched before."""
        with self._change:
            before, self._guard = self._guard, guard
            if guard is not None:
                guard.seen = None
                if self._thread is None:
                    self._thread = threading.Thread(target=self._loop, name="turtle_lesson watchdog", daemon=True)
                    self._thread.start()
                if not self._wanted.is_set():
                    self._wanted.set()
        return before

    @property
    def interrupted(self) -> bool:
        """Whether the user has interrupted the run that is watched."""
        return self._guard is not None and self._guard.interrupted

    def begin_anew(self) -> None:
        """In a forked process no thread but the one that forked goes on, and what others held is held for ever."""
        self.__init__()  # type: ignore[misc]

    def stop(self) -> None:
        """Have it end, until the next run; it watches nothing now."""
        thread, self._thread = self._thread, None
        if thread is not None:
            self._wanted.set()
            thread.join()
            self._wanted.clear()

    def _loop(self) -> None:
        while self._thread is threading.current_thread():
            self._wanted.wait()
            self.look()
            _sleep(min(0.25, patience / 4, interrupt_patience / 4))

    def look(self) -> None:
        """Interrupt the main thread if the clock has stood still for too long since it was first seen to; else rest."""
        with self._change:
            if self._guard is not None:
                self._look_at(self._guard)
            else:
                self._wanted.clear()

    def _look_at(self, guard: Guard) -> None:
        state, now, work = (guard.simulation.now, guard.interrupted), _monotonic(), work_done()
        stepped = guard.simulation.stepped
        # what is run step by step may compute for as long as a cell
        excused = stepped is not None and stepped.computes and not guard.interrupted
        if state != guard.seen or excused or _is_excused(sys._current_frames().get(_main_thread.ident or 0)):
            guard.seen, guard.since, guard.computed = state, now, work
        waited, computed = now - guard.since, work - guard.computed
        waiting = computed < WAITING * waited
        if waited > interrupt_patience if guard.interrupted else (waited if waiting else computed) > patience:
            guard.seen, guard.waiting, guard.tripped_at = None, waiting, guard.simulation.now
            _interrupt_main_thread()
        until = guard.simulation.work_until
        if until is not None and work > until:
            guard.spent = True
            _interrupt_main_thread()


def work_done() -> float:
    """The CPU time, in s, of the main thread."""
    if hasattr(time, "pthread_getcpuclockid"):
        return time.clock_gettime(time.pthread_getcpuclockid(_main_thread.ident or 0))
    import psutil

    threads = psutil.Process().threads()  # on macOS they are only numbered, the main thread first
    mine = next((each for each in threads if each.id == _main_thread.native_id), threads[0])
    return mine.user_time + mine.system_time


def _interrupt_main_thread() -> None:
    """Have the main thread run its signal handler, also if it waits for a lock (where the system can do that)."""
    if _signal_thread is not None:
        _signal_thread(_main_thread.ident or 0, signal.SIGINT)
    else:
        _thread.interrupt_main()


watchdog = Watchdog()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=watchdog.begin_anew)


# -- what the main thread is doing ---------------------------------------------------------------------------------------

_ASKING = {"raw_input", "_input_request", "_answer_of_the_cell"}
"""The functions in which Jupyter's input(), and that of a program in a script, wait for the user."""

_KINDS = {
    **dict.fromkeys(JUPYTER, "jupyter"),
    **dict.fromkeys(("importlib._bootstrap", "importlib._bootstrap_external"), "import"),
    **dict.fromkeys(("bdb", "pdb", "IPython.core.debugger"), "debugger"),
    "rclpy.executors": "executor",
}
"""What kind of code a module, or a whole package, is."""


def _kind(frame: FrameType) -> str:
    """What kind of code a frame runs: a "question" to the user, a "learner"'s, one of `_KINDS`, or of another "library"."""
    if frame.f_code.co_name in _ASKING:
        return "question"
    if is_learners(frame.f_code.co_filename):
        return "learner"
    name = frame.f_globals.get("__name__", "")
    return _KINDS.get(name) or _KINDS.get(name.partition(".")[0], "library")


def _kinds(frame: FrameType | None) -> list[str]:
    """The kinds of a frame and of those that have called it."""
    kinds = []
    while frame is not None:
        kinds.append(_kind(frame))
        frame = frame.f_back
    return kinds


def _kinds_called(frame: FrameType | None) -> list[str]:
    """The kinds of what a learner's code has called here."""
    return list(takewhile(lambda kind: kind != "learner", _kinds(frame)))


def _is_excused(frame: FrameType | None) -> bool:
    """Whether what the main thread does now does not count: it imports a library, or waits for its user."""
    return "import" in _kinds_called(frame) or not {"question", "debugger"}.isdisjoint(_kinds(frame))


def _must_go_on(frame: FrameType | None) -> bool:
    """Whether Jupyter, as in a print, or an import is at work here: it may hold a lock that Jupyter's threads wait for."""
    return not {"jupyter", "import"}.isdisjoint(_kinds_called(frame))


def _learners_call(frame: FrameType | None) -> FrameType | None:
    """The call of a learner's function that goes on here, the outermost since an executor or Jupyter called; or None."""
    call = None
    while frame is not None and _kind(frame) not in ("executor", "jupyter"):
        call = frame if _kind(frame) == "learner" else call
        frame = frame.f_back
    return call
