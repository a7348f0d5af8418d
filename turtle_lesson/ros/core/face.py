"""What a running process shows to Python: `sys.argv`, `sys.stdout`, `sys.stderr`, and its modules while it imports.

They are changed when another process goes on, and are the cell's again when the cell goes on.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .process import Process
    from .program_modules import ProgramModules


_sys = vars(sys)
"""Set directly, as it is done at each switch: that takes half the time."""


class Face:
    """Part of the simulation.

    Attributes:
        modules_shown: whose modules are in `sys.modules`, if a program has been importing.
    """

    def __init__(self) -> None:
        self.modules_shown: ProgramModules | None = None
        self._face: Process | None = None
        self._cell_face: Any = ()

    def _enter(self, process: Process) -> None:
        if self._face is None:
            self._cell_face = (sys.argv, sys.stdout, sys.stderr)
        elif self.modules_shown is not None and self.modules_shown is not process.modules:
            self.modules_shown.hide()
        self._face = process
        _sys["argv"] = process.argv
        _sys["stdout"] = process.stdout or self._cell_face[1]
        _sys["stderr"] = process.stderr or self._cell_face[2]

    def _leave(self) -> None:
        if self._face is not None:
            sys.argv, sys.stdout, sys.stderr = self._cell_face
            self._face = None
            if self.modules_shown is not None:
                self.modules_shown.hide()

    @property
    def cell_stdout(self) -> Any:
        """Where the running cell prints to."""
        return sys.stdout if self._face is None else self._cell_face[1]
