"""A simulated process: what an executable's `main()` becomes, with its own argv, random numbers, output and exit code.

A process is *alive* (it has a strand that can go on), then *dead* (`exit_code` is set). Exit codes are Python's:
0 after `main()` returned, 1 after an exception, the code of `sys.exit`, -2 after an interrupt that nobody caught.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from io import StringIO
from random import Random
from typing import Any, Protocol

from .simulation import Simulation
from .strand import Strand, running_strand
from .tracebacks import print_error

INTERRUPTED = -2
KILLED = -9


class Output(Protocol):
    """Where a process prints to: any text stream."""

    def write(self, text: str, /) -> object:
        """Take a text."""

    def flush(self) -> None:
        """Show what was written."""


class Process:
    """A program in the simulation. `locals` is where libraries keep what each process has one of."""

    def __init__(
        self,
        simulation: Simulation,
        name: str,
        *,
        pid: int,
        seed: str,
        argv: Sequence[str] = (),
        stdout: Output | None = None,
        stderr: Output | None = None,
        on_exit: Callable[[Process], None] | None = None,
    ) -> None:
        self.simulation = simulation
        self.name = name
        self.pid = pid
        self.argv = list(argv)
        self.random = Random(seed)
        self.seed = seed
        self.stdout: Any = stdout
        self.stderr: Any = stderr
        self.exit_code: int | None = None
        self.locals: dict[str, Any] = {}
        self.at_exit: list[Callable[[], None]] = []
        self.error: BaseException | None = None
        self._on_exit = on_exit
        self._strands: list[Strand] = []
        self._main: Strand | None = None

    def __repr__(self) -> str:
        state = "alive" if self.alive else f"exited with {self.exit_code}"
        return f"<Process {self.name} [{self.pid}], {state}>"

    @property
    def alive(self) -> bool:
        """Whether the process has not ended yet."""
        return self.exit_code is None

    def start(self, program: Callable[[], object]) -> None:
        """Begin to run `program` as the process's main strand, at this instant."""

        def main() -> None:
            self._run_main(program)

        self._main = self.add_strand(main)
        self._main.parked = True
        self.simulation.wake(self._main)

    def add_strand(self, target: Callable[[], Any]) -> Strand:
        """Make another line of execution in this process; it starts when it is made ready."""
        self._strands = [strand for strand in self._strands if not strand.dead]
        strand = Strand(self, target)
        self._strands.append(strand)
        return strand

    def interrupt(self) -> None:
        """Do as Ctrl-C in a terminal would: raise KeyboardInterrupt in the main strand, now."""
        self._end_main(KeyboardInterrupt())

    def kill(self) -> None:
        """End the process without asking; its `finally` blocks still run, but none of them may wait."""
        self._end_main(SystemExit(KILLED))
        self.abandon(None)

    def close(self) -> None:
        """End the process in silence, because its world ends: nobody is told, and nothing it says is shown."""
        self._on_exit = None
        self.stdout = self.stderr = StringIO()
        self.kill()

    def abandon(self, reason: str | None) -> None:
        """Take the process for dead although its program has not ended: it never runs again."""
        if not self.alive:
            return
        if reason:
            print(f"{self.name}: given up, because {reason}", file=self.stderr or sys.stderr)
        self._finish(KILLED)

    def _end_main(self, error: BaseException) -> None:
        main = self._main
        if not self.alive or main is None:
            return
        if main is running_strand():
            raise error
        if not main:  # it has not even begun
            self._finish(INTERRUPTED if isinstance(error, KeyboardInterrupt) else KILLED)
            return
        self.simulation.raise_in(main, error)

    def _run_main(self, program: Callable[[], object]) -> None:
        code = 1
        try:
            program()
            code = 0
        except SystemExit as error:
            code = self._exit_status(error)
        except KeyboardInterrupt as error:
            code = INTERRUPTED
            self._show(error)
        except BaseException as error:
            self._show(error)
        finally:
            self._finish(code)

    def _exit_status(self, error: SystemExit) -> int:
        if error.code is None:
            return 0
        if isinstance(error.code, int):
            return error.code
        print(error.code, file=sys.stderr)
        return 1

    def _show(self, error: BaseException) -> None:
        if self.alive:
            self.error = error
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
        self._drop_other_strands()
        if self._on_exit is not None:
            self._on_exit(self)

    def _drop_other_strands(self) -> None:
        """Workers end with their process: they are never resumed again, wherever they stand."""
        current = running_strand()
        for strand in self._strands:
            if strand is not current:
                self.simulation.forget(strand)
