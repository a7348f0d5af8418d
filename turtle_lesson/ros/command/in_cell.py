"""Commands that need neither robot time nor a node: they run in the cell itself, not as a process."""

from __future__ import annotations

from .common import Command
from .common import CommandError as CommandError


class CellCommand(Command):
    """As `Command`, but run in the cell."""

    in_cell = True
