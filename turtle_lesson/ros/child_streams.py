"""Where the programs that a program starts print, and how it reads that in robot time."""

from __future__ import annotations

import io
import subprocess
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .core import NANOSECONDS, Simulation, Strand, running_strand

if TYPE_CHECKING:
    from .core.process import Output


STEP = 10_000_000
"""How far (ns) the world is run between two looks, for a cell that waits."""


class News:
    """Something that strands wait for, in robot time."""

    def __init__(self) -> None:
        self._waiting: list[Strand] = []

    def tell(self) -> None:
        """Have those who wait look again."""
        for strand in self._waiting:
            strand.simulation.wake(strand)

    def wait_for(self, is_there: Callable[[], bool], seconds: float | None = None) -> bool:
        """Hold up the running strand, or run the world, until it is there, at most `seconds`; whether it is."""
        from .world import current_world

        strand, simulation = running_strand(), current_world().sim
        deadline = None if seconds is None else simulation.now + round(seconds * NANOSECONDS)
        if strand is None:
            return _run_until(simulation, is_there, deadline)
        if deadline is not None:
            simulation.at(deadline, simulation.wake, strand)
        self._waiting.append(strand)
        try:
            while not is_there():
                if deadline is not None and simulation.now >= deadline:
                    return False
                simulation.park(strand)
            return True
        finally:
            self._waiting.remove(strand)


def _run_until(simulation: Simulation, is_there: Callable[[], bool], deadline: int | None) -> bool:
    while not is_there():
        if deadline is not None and simulation.now >= deadline:
            return False
        simulation.run_until(simulation.now + STEP)
    return True


class Pipe(io.TextIOBase):
    """What a child prints, for its parent to read: lines as they come, and all when it has ended."""

    def __init__(self, text: bool) -> None:
        self._text = text
        self._pending = ""
        self._at_end = False
        self._news = News()

    def write(self, text: str) -> int:
        """The child prints."""
        self._pending += text
        self._news.tell()
        return len(text)

    def end(self) -> None:
        """Nothing more will come."""
        self._at_end = True
        self._news.tell()

    def read(self, size: int | None = -1) -> Any:
        """All, once the child has ended; or as many characters as are asked for."""
        wanted = -1 if size is None else size
        self._news.wait_for(lambda: self._at_end or 0 <= wanted <= len(self._pending))
        return self._take(len(self._pending) if wanted < 0 else wanted)

    def readline(self, size: int = -1) -> Any:  # type: ignore[override]
        """The next line, as soon as there is one."""
        self._news.wait_for(lambda: self._at_end or "\n" in self._pending)
        return self._take((self._pending.find("\n") + 1) or len(self._pending))

    def _take(self, count: int) -> str | bytes:
        taken, self._pending = self._pending[:count], self._pending[count:]
        return taken if self._text else taken.encode()

    def __next__(self) -> Any:
        if line := self.readline():
            return line
        raise StopIteration


class _Nowhere(io.TextIOBase):
    def write(self, text: str) -> int:
        return len(text)


class _ToBytes(io.TextIOBase):
    """A file of bytes, into which a child prints text."""

    def __init__(self, file: Any) -> None:
        self._file = file

    def write(self, text: str) -> int:
        self._file.write(text.encode())
        self._file.flush()
        return len(text)


def stream_for(wanted: Any, inherited: Output | None, text: bool) -> tuple[Any, Any]:
    """Where a child prints, and what its parent reads."""
    if wanted is None:
        return inherited, None
    if wanted == subprocess.PIPE:
        pipe = Pipe(text)
        return pipe, pipe
    if wanted == subprocess.DEVNULL:
        return _Nowhere(), None
    if isinstance(wanted, int):
        raise NotImplementedError("a file descriptor cannot be used here: give the file itself, or PIPE")
    return (wanted if "b" not in getattr(wanted, "mode", "") else _ToBytes(wanted)), None


__all__ = ["News", "Pipe", "stream_for"]
