"""Streams that print into others; where a process's words go when nobody else catches them: the running cell's output."""

from __future__ import annotations

from io import TextIOBase
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .core import Simulation


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
