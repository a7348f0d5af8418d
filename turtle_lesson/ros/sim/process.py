"""A simulated process: what an executable's `main()` becomes, with its own argv, random numbers, output and exit code.

A process is *alive* (it has a strand that can go on), then *dead* (`exit_code` is set). Exit codes are Python's:
0 after `main()` returned, 1 after an exception, the code of `sys.exit`, -2 after an interrupt that nobody caught.
After `main()` the process lives on as long as a thread of it does that is no daemon.
"""

from __future__ import annotations

import signal
import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass, field
from functools import partial
from io import StringIO
from random import Random
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from .. import hooks
from .errors import print_error
from .simulation import Simulation
from .strand import Strand, running_strand

if TYPE_CHECKING:
    from ..runtime.world import World

INTERRUPTED = -2
KILLED = -9


class Output(Protocol):
    """Where a process prints to: any text stream."""

    def write(self, text: str, /) -> object:
        """Take a text."""

    def flush(self) -> None:
        """Show what was written."""


class Killed(SystemExit):
    """Ends a process that is not asked."""

    code: int


S = TypeVar("S")


@dataclass(eq=False, repr=False)
class Process:
    """A program in the simulation. With `state` libraries keep what each process has one of.

    Attributes:
        is_notebook: whether it stands for a notebook, whose cells drive the simulation.
        world: what it runs in; the simulation does not look at it.
        stdin: the file or pipe that it reads as its standard input; None: the world's keyboard.
        environ: the environment variables of its own, as the system encodes them; None: Python's own.
        strands: its lines of execution, in the order of their making; dead ones may be among them.
        modules: the Python modules of its own that a program has which was read from a file.
        followers: processes that it has started in the same terminal, which Ctrl-C reaches, too.
        before_exit: called when the main program has ended, the last one first: waits for what is still at work.
        exit_functions: called after that, the last one first: what the program gave to `atexit.register`.
        at_exit: called at the very end, the last one first, however the process ends: what libraries clean up.
        signal_handlers: as the program has set them with `signal.signal`, by the number of the signal; else SIG_DFL.
        signal_hook: called with a signal before that, by a library; returns whether that is the end of it.
        noticed: whether a notice has said that it holds up robot time.
    """

    simulation: Simulation
    name: str
    _: KW_ONLY
    pid: int
    seed: str
    world: World
    argv: list[str] = field(default_factory=list)
    stdout: Any = None
    stderr: Any = None
    stdin: Any = None
    on_exit: Callable[[Process], None] | None = None
    exit_code: int | None = None
    followers: list[Process] = field(default_factory=list)
    before_exit: list[Callable[[], None]] = field(default_factory=list)
    exit_functions: list[partial[object]] = field(default_factory=list)
    at_exit: list[Callable[[], None]] = field(default_factory=list)
    signal_handlers: dict[int, Any] = field(default_factory=lambda: {signal.SIGINT: signal.default_int_handler})
    signal_hook: Callable[[int], bool] | None = None
    noticed: bool = False
    error: BaseException | None = None
    is_notebook: bool = False
    modules: Any = None
    environ: dict[Any, Any] | None = None
    main_strand: Strand | None = None
    strands: list[Strand] = field(default_factory=list)
    _states: dict[type, Any] = field(default_factory=dict)
    _numbers: Counter[str] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        self.random = Random(self.seed)

    def state(self, kind: type[S], *arguments: Any) -> S:
        """What a module keeps of this process: its one object of this class, made of the arguments when first asked for."""
        found = self._states.get(kind)
        if found is None:
            found = self._states[kind] = kind(*arguments)
        return found

    @property
    def alive(self) -> bool:
        """Whether the process has not ended yet."""
        return self.exit_code is None

    def start(self, program: Callable[[], object], start_up: int = 0) -> None:
        """Begin to run `program` as the process's main strand, `start_up` ns from now. Until then it can be ended as ever."""
        self.main_strand = self.add_strand(partial(self._run_main, program))
        self.main_strand.parked = True
        if start_up:
            self.simulation.at(self.simulation.now + start_up, self.simulation.wake, self.main_strand)
        else:
            self.simulation.wake(self.main_strand)

    def add_strand(self, target: Callable[[], Any]) -> Strand:
        """Make another line of execution in this process; it starts when it is made ready."""
        while self.strands and self.strands[-1].dead:  # a notebook's end with the call that they were made for
            self.strands.pop()
        strand = Strand(self, target)
        self.strands.append(strand)
        return strand

    def next_number(self, kind: str) -> int:
        """The number of one more thing of a kind in this process, from 1."""
        self._numbers[kind] += 1
        return self._numbers[kind]

    def interrupt(self) -> None:
        """Do as Ctrl-C in a terminal would: SIGINT, which raises KeyboardInterrupt in the main strand, now."""
        for process in self.followers:
            if process.alive:
                process.interrupt()
        self.send_signal(signal.SIGINT)

    def send_signal(self, number: int) -> None:
        """Have the process get a signal: its own handler is called in the main strand, or does what Python does."""
        main, hook, handler = self.main_strand, self.signal_hook, self.signal_handlers.get(number, signal.SIG_DFL)
        if not self.alive or (hook is not None and hook(number)) or handler is signal.SIG_IGN:
            return
        if handler is signal.default_int_handler:
            self._end_main(KeyboardInterrupt())
        elif not main or not callable(handler):
            self.kill(-number)
        elif main is running_strand():
            handler(number, sys._getframe(1))
        else:
            self.simulation.call_in(main, lambda: handler(number, sys._getframe(2)))

    def kill(self, code: int = KILLED) -> None:
        """End the process without asking; its `finally` blocks still run, but none of them may wait."""
        self._end_main(Killed(code))
        self._finish(code)

    def end_now(self, code: int) -> None:
        """End the process in its middle; its running strand never returns from here."""
        strand = running_strand()
        assert strand is not None
        self._finish(code)
        self.simulation.forget(strand)
        self.simulation.park(strand)

    def close(self) -> None:
        """End the process in silence, because its world ends: nobody is told, and nothing it says is shown."""
        self.on_exit = None
        self.stdout = self.stderr = StringIO()
        self.kill()

    def abandon(self, reason: str) -> None:
        """Take the process for dead although its program has not ended: it never runs again."""
        if self.alive:
            print(f"{self.name}: given up, because {reason}", file=self.stderr or sys.stderr)
        self._finish(KILLED)

    def _end_main(self, error: KeyboardInterrupt | Killed) -> None:
        main = self.main_strand
        if not self.alive or main is None:
            return
        if main is running_strand():
            raise error
        if not main:  # it has not even begun
            self._finish(error.code if isinstance(error, Killed) else INTERRUPTED)
            return
        self.simulation.raise_in(main, error)

    def _run_main(self, program: Callable[[], object]) -> None:
        code = KILLED
        try:
            ended_with = self._code_of(program)
            if self.alive:
                hooks.wind_down(self)
            code = ended_with
        except Killed as error:  # in the program, or while it was waiting for its threads
            code = error.code
        finally:
            self._finish(code)

    def _code_of(self, program: Callable[[], object]) -> int:
        """Run the main program; the exit code that it ends with."""
        try:
            program()
            return 0
        except Killed:
            raise
        except SystemExit as error:
            if error.code is None or isinstance(error.code, int):
                return error.code or 0
            print(error.code, file=sys.stderr)
            return 1
        except BaseException as error:
            self._show(error)
            return INTERRUPTED if isinstance(error, KeyboardInterrupt) else 1

    def _show(self, error: BaseException) -> None:
        if self.alive:
            self.error = error
            if self.modules is not None and "excepthook" in vars(self.modules.sys):
                self.modules.sys.excepthook(type(error), error, error.__traceback__)
            else:
                print_error(error, sys.stderr)

    def _finish(self, code: int) -> None:
        if not self.alive:
            return
        self.exit_code = code
        for clean_up in reversed(self.at_exit):
            try:
                clean_up()
            except Exception as error:  # the rest is to be cleaned up all the same
                print_error(error, self.stderr or sys.stderr)
        self.at_exit.clear()
        current = running_strand()
        for strand in self.strands:  # workers end with their process: they are never resumed again, wherever they stand
            if strand is not current:
                self.simulation.forget(strand)
        if self.on_exit is not None:
            self.on_exit(self)
