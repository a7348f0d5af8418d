"""Where a command's words go: the cell's stdout and stderr, in the order in which they were written."""

from __future__ import annotations

import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TextIO

from ..console import BorrowedStream, CellOutput, FileOutput

if TYPE_CHECKING:
    from ..core import Simulation

LONGEST = 1500
"""How many characters of a line of stderr are shown: nobody reads on in a name of 10,000."""


class CellErrors(BorrowedStream):
    """A cell's stderr. It flushes both streams where it writes: else Jupyter would mix up their order."""

    def __init__(self, target: TextIO, other: TextIO) -> None:
        self._target = target
        self._other = other

    def write(self, text: str) -> int:
        """Print a text, as it is."""
        self._other.flush()
        written = self._target.write(text)
        if text.endswith("\n"):
            self._target.flush()
        return written

    def flush(self) -> None:
        """Show what was written. Python flushes once more at the very end, when the cell's stream may be closed."""
        with suppress(ValueError):
            self._target.flush()


def cell_streams() -> tuple[TextIO, CellErrors]:
    """The running cell's stdout and stderr."""
    return sys.stdout, CellErrors(sys.stderr, sys.stdout)


class Errors(BorrowedStream):
    """A command's stderr: what was typed is repeated in it, so endless lines are cut and control characters named."""

    def __init__(self, target: Any) -> None:
        self._target = target
        self._column = 0

    def write(self, text: str) -> int:
        """Print a text, made fit to be printed."""
        for line in text.splitlines(keepends=True) if "\n" in text else [text]:
            self._write_line(line)
        return len(text)

    def _write_line(self, line: str) -> None:
        end = "\n" if line.endswith("\n") else ""
        shown = "".join(
            char if char.isprintable() or char == "\t" else repr(char)[1:-1]
            for char in line.removesuffix("\n")[:LONGEST]
        )
        if self._column < LONGEST:
            self._target.write(shown if self._column + len(line) <= LONGEST else f"{shown}…")
        self._target.write(end)
        self._column = 0 if end else self._column + len(line)

    def flush(self) -> None:
        """Show what was written. Python flushes once more at the very end, when the cell's stream may be closed."""
        with suppress(ValueError):
            self._target.flush()


def lasting(stream: Any, simulation: Simulation) -> BorrowedStream:
    """Where a program prints that goes on after its command: into the file behind `>`, or else into the running cell."""
    target = stream._target if isinstance(stream, Errors) else stream
    return target if isinstance(target, FileOutput) else CellOutput(simulation)
