"""What `ros2 run`, `ros2 launch` and a trailing `&` leave running, and the streams that commands print to."""

from __future__ import annotations

import sys
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TextIO

from ..runtime.console import BorrowedStream, CellOutput, FileOutput
from ..sim.process import Process
from .arguments import printable

if TYPE_CHECKING:
    from ..launching import LaunchHandle
    from ..runtime.world import World
    from ..sim.simulation import Simulation


SIGNALS = {"INT": 2, "TERM": 15, "KILL": 9}


class Jobs:
    """The jobs of one world, in the order of their start."""

    def __init__(self) -> None:
        self._jobs: list[Job] = []
        self._count = 0

    def add(self, job: Job) -> Job:
        """Number a new job."""
        self._count += 1
        job.number = self._count
        self._jobs.append(job)
        return job

    @property
    def running(self) -> list[Job]:
        """Those that have not ended."""
        self._jobs = [job for job in self._jobs if job.running]
        return list(self._jobs)

    def get(self, number: int) -> Job | None:
        """The running job of this number."""
        return next((job for job in self.running if job.number == number), None)


@dataclass
class Job:
    """One command that goes on.

    Attributes:
        words: the command, as it was typed.
        what: the process that runs, or the handle of a launch.
        number: its number, as in `%1`.
    """

    words: str
    what: Process | LaunchHandle
    number: int = field(default=0)

    @property
    def running(self) -> bool:
        """Whether it has not ended."""
        return self.what.alive if isinstance(self.what, Process) else self.what.running

    def signal(self, name: str) -> None:
        """Send it INT (Ctrl-C), TERM or KILL."""
        if isinstance(self.what, Process):
            send(self.what, name)
        else:
            self.what.stop()


@dataclass
class LastSignal:
    """The signal that ended a process, if the terminal sent one."""

    name: str = ""


def send(process: Process, name: str) -> None:
    """Send a process INT (Ctrl-C), TERM or KILL."""
    if name == "INT":
        process.interrupt()
    else:
        process.state(LastSignal).name = name
        process.kill()


def jobs(world: World) -> Jobs:
    """The jobs of a world."""
    return world.notebook.state(Jobs)


# -- the streams of a cell and of a command --------------------------------------------------------------------------

LONGEST = 1500
"""How many characters of a line of stderr are shown: nobody reads on in a name of 10,000."""


class _Stream(BorrowedStream):
    """A stream that prints into another one."""

    def __init__(self, target: Any) -> None:
        self._target = target

    def flush(self) -> None:
        """Show what was written. Python flushes once more at the very end, when the cell's stream may be closed."""
        with suppress(ValueError):
            self._target.flush()


class CellErrors(_Stream):
    """A cell's stderr. It flushes both streams where it writes: else Jupyter would mix up their order."""

    def __init__(self, target: TextIO, other: TextIO) -> None:
        super().__init__(target)
        self._other = other

    def write(self, text: str) -> int:
        """Print a text, as it is."""
        self._other.flush()
        written: int = self._target.write(text)
        if text.endswith("\n"):
            self._target.flush()
        return written


def cell_streams() -> tuple[TextIO, CellErrors]:
    """The running cell's stdout and stderr."""
    return sys.stdout, CellErrors(sys.stderr, sys.stdout)


class Errors(_Stream):
    """A command's stderr: what was typed is repeated in it, so endless lines are cut and control characters named."""

    _column = 0

    def write(self, text: str) -> int:
        """Print a text, made fit to be printed."""
        for line in text.splitlines(keepends=True) if "\n" in text else [text]:
            self._write_line(line)
        return len(text)

    def _write_line(self, line: str) -> None:
        end = "\n" if line.endswith("\n") else ""
        shown = printable(line.removesuffix("\n")[:LONGEST])
        if self._column < LONGEST:
            self._target.write(shown if self._column + len(line) <= LONGEST else f"{shown}…")
        self._target.write(end)
        self._column = 0 if end else self._column + len(line)


def lasting(stream: Any, simulation: Simulation) -> BorrowedStream:
    """Where a program prints that goes on after its command: into the file behind `>`, or else into the running cell."""
    target = stream._target if isinstance(stream, Errors) else stream
    return target if isinstance(target, FileOutput) else CellOutput(simulation)
