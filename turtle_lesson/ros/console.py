"""Where a simulated process's words go when nobody else catches them: the output of the cell that is running."""

from __future__ import annotations

from io import TextIOBase
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .core import Simulation


class CellOutput(TextIOBase):
    """A text stream that prints in the running cell's ordinary output, also what a process says on its stderr."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def writable(self) -> bool:
        """It can be written to."""
        return True

    def write(self, text: str) -> int:
        """Print a text, as it is."""
        return self._simulation.cell_stdout.write(text)

    def flush(self) -> None:
        """Show what was written."""
        self._simulation.cell_stdout.flush()
