"""What the commands of the terminal work with: its streams, options and environment variables, and what goes on running."""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from typing import TextIO

from ..launching.service import LaunchHandle
from ..runtime.files import BorrowedStream, CellOutput, FileOutput
from ..runtime.world import World
from ..sim.process import Output, Process
from ..sim.simulation import Simulation
from .arguments import cut

SIGNALS = {"INT": 2, "TERM": 15, "KILL": 9}


class Jobs:
    """The jobs of one world, in the order of their start."""

    def __init__(self) -> None:
        self._jobs: list[Job] = []
        self._count = 0

    def add(self, words: str, what: Process | LaunchHandle) -> Job:
        """Number a new job."""
        self._count += 1
        self._jobs.append(Job(words, what, self._count))
        return self._jobs[-1]

    @property
    def running(self) -> list[Job]:
        """Those that have not ended."""
        self._jobs = [job for job in self._jobs if job.running]
        return list(self._jobs)


@dataclass
class Job:
    """A command that goes on, as it was typed: a process or a launch, with its number, as in `%1`."""

    words: str
    what: Process | LaunchHandle
    number: int

    @property
    def running(self) -> bool:
        """Whether it has not ended."""
        return self.what.alive if isinstance(self.what, Process) else self.what.running


def send(what: Process | LaunchHandle, name: str) -> None:
    """Send a process INT (Ctrl-C), TERM or KILL; each of them stops a launch."""
    if not isinstance(what, Process):
        what.stop()
    elif name == "INT":
        what.interrupt()
    else:
        what.kill(-SIGNALS[name])


def jobs(world: World) -> Jobs:
    """The jobs of a world."""
    return world.notebook.state(Jobs)


# -- the streams of a cell and of a command --------------------------------------------------------------------------


class _Stream(BorrowedStream):
    """A stream that prints into another one."""

    def __init__(self, target: Output) -> None:
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
        self._target.write(text)
        if text.endswith("\n"):
            self._target.flush()
        return len(text)


class Errors(_Stream):
    """A command's stderr: what was typed is repeated in it, so endless lines are cut and control characters named."""

    def write(self, text: str) -> int:
        """Print a text, made fit to be printed."""
        self._target.write("\n".join(map(cut, text.split("\n"))))
        return len(text)


def lasting(stream: Output, simulation: Simulation) -> BorrowedStream:
    """Where a program prints that goes on after its command: into the file behind `>`, or else into the running cell."""
    target = stream._target if isinstance(stream, Errors) else stream
    return target if isinstance(target, FileOutput) else CellOutput(simulation)


# -- a command's world, streams and options ----------------------------------------------------------------------------


@dataclass
class Terminal:
    """What a command of the terminal works with."""

    world: World
    stdout: Output
    stderr: Output
    given: str | None = None

    def say(self, *lines: object) -> int:
        """Print lines; returns exit code 0."""
        for line in lines:
            print(line, file=self.stdout)
        return 0

    def for_each(self, names: Iterable[str], do: Callable[[Path], object], cannot: str) -> int:
        """Do something with each file; print why for one with which it fails. Returns 1 if there was such a one, else 0."""
        code = 0
        for name in names:
            try:
                do(Path(name))
            except OSError as error:
                code = 1
                print(f"{cannot} '{name}': {error.strerror or error}", file=self.stderr)
        return code


Builtin = Callable[[Terminal, list[str]], int]


def options(words: list[str], known: str, example: str = "", least: int = 1) -> tuple[set[str], list[str]]:
    """The letters after `-`, and the other words.

    Raises ValueError for a letter that is not known and for `--word`, and for too few words if there is an example of use.
    """
    given = [word for word in words if re.fullmatch("-[A-Za-z0-9]+|--[a-z].*", word)]
    for word in given:
        if word.startswith("--") or not set(word[1:]) <= set(known):
            raise ValueError(f"no option {word} here; known: {', '.join(f'-{each}' for each in known) or 'none'}")
    rest = [word for word in words if word not in (*given, "--")]
    if example and len(rest) < least:
        raise ValueError(f"missing operand; it is used as in {example}")
    return set("".join(given)) - {"-"}, rest


# -- environment variables -------------------------------------------------------------------------------------------
# They are the notebook's own variables, which each process has a copy of when it begins.

_ASSIGNMENT = re.compile(r"([A-Za-z_]\w*)=(.*)", re.DOTALL)


def export(terminal: Terminal, words: list[str]) -> int:
    """`export NAME=value…`: set variables for what is started from now on."""
    for word in words:
        name, sign, value = word.partition("=")
        if not name.isidentifier():
            raise ValueError(f"{word!r} is not the name of a variable: write export NAME=value, without spaces")
        if sign:
            os.environ[name] = value
    return 0 if words else printenv(terminal, words)


def unset(terminal: Terminal, words: list[str]) -> int:
    """`unset NAME…`: have variables no more."""
    for word in words:
        if not word.isidentifier():
            raise ValueError(f"{word!r} is not the name of a variable")
        os.environ.pop(word, None)
    return 0


def printenv(terminal: Terminal, words: list[str]) -> int:
    """`printenv [NAME…]`: print variables; of one that is not set nothing but the exit code 1."""
    if not words:
        return terminal.say(*(f"{name}={value}" for name, value in sorted(os.environ.items())))
    there = [os.environ[name] for name in words if name in os.environ]
    terminal.say(*there)
    return 0 if len(there) == len(words) else 1


def before_a_command(words: Sequence[str]) -> dict[str, str]:
    """The `NAME=value` with which a command's words begin."""
    found = takewhile(bool, map(_ASSIGNMENT.fullmatch, words))
    return {each[1]: each[2] for each in found if each}


@contextlib.contextmanager
def set_for_now(variables: dict[str, str]) -> Iterator[None]:
    """Have variables set for what is started within."""
    before = {name: os.environ[name] for name in variables if name in os.environ}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name in variables:
            os.environ.pop(name, None)
        os.environ.update(before)
