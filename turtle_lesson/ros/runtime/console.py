"""Streams that print into others; where a process's words go when nobody else catches them: the running cell's output."""

from __future__ import annotations

from contextlib import suppress
from io import TextIOBase
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from . import files

if TYPE_CHECKING:
    from ..sim.simulation import Simulation


class BorrowedStream(TextIOBase):
    """A text stream that prints into another one, which lives on when nobody holds this one any more."""

    def writable(self) -> bool:
        """It can be written to."""
        return True

    def __del__(self) -> None:
        """Python would flush it, wherever the running code stands: in Jupyter that waits, and swallows an interrupt."""


class CellOutput(BorrowedStream):
    """A text stream that prints in the running cell's ordinary output, also what a process says on its stderr."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def write(self, text: str) -> int:
        """Print a text, as it is."""
        return self._simulation.cell_stdout.write(text)

    def flush(self) -> None:
        """Show what was written."""
        self._simulation.cell_stdout.flush()


class FileOutput(BorrowedStream):
    """A text stream that appends to a file as long as anybody prints: behind `>`, a program may outlast its command.

    No file stays open. What is printed after its folder was removed is lost, as on Linux. `instead_of` is the stream that
    it stands for: a command's note that its program goes on belongs there.
    """

    def __init__(self, path: Path, instead_of: TextIO) -> None:
        self._path = path.absolute()
        self._file = self._identity()
        self.instead_of = instead_of

    def write(self, text: str) -> int:
        """Append a text, as it is."""
        if self._identity() != self._file:  # somebody has put another in its place, or a link
            files.check(self._path)
        with suppress(FileNotFoundError), self._path.open("a", encoding="utf-8", errors="surrogateescape") as file:
            file.write(text)
        return len(text)

    def _identity(self) -> tuple[int, int] | None:
        with suppress(OSError):
            about = self._path.stat()
            return about.st_dev, about.st_ino
        return None
