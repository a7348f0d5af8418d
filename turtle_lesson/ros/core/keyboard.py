"""What is typed at a world: the lines that programs ask for with `input()`, and the keys that they read one by one.

A line comes from what was typed ahead, or else from the running cell: in a notebook from the prompt below it, in a script
from Python's own `input`. Robot time stands still while somebody thinks about an answer.
"""

from __future__ import annotations

import builtins
import sys
import time
from collections import deque
from types import BuiltinFunctionType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .process import Process
    from .simulation import Simulation

_monotonic = time.monotonic  # the real one, whatever time.monotonic becomes

TYPING = 1_000_000_000
"""How long, in ns, the next line takes to type if the program has done something since its last one.

Without it, a loop that asks and publishes would never let time pass, and its robot would never move.
"""

MOMENT = 1_000_000
"""What happens within so many ns counts as the same instant: reading clocks takes time, too."""

PAUSE = 100_000_000
"""How often, in ns, a program that asks between two cells of a notebook looks whether a cell runs."""

END = "EOF when reading a line"
"""Python's words for an input that has ended."""


class Keyboard:
    """The keyboard of a world, which its programs share.

    Attributes:
        lines: lines that were typed ahead, for the programs that ask next.
        live: whether time goes on by itself now, run by no cell, so that no cell can ask.
        seconds_asked: how long, in s of real time, programs have waited for answers of the cell.
    """

    def __init__(self, simulation: Simulation) -> None:
        self.lines: deque[str] = deque()
        self.live = False
        self.seconds_asked = 0.0
        self._simulation = simulation
        self._last: tuple[int, int] | None = None

    def line(self, process: Process, prompt: str) -> str:
        """The next line that is typed for a program, without its line end.

        Raises:
            EOFError: if no line was typed ahead and the cell cannot be asked.
            KeyboardInterrupt: if the user stops the cell while it asks.
        """
        self._let_time_for_typing_pass()
        if not self.lines:
            self._wait_for_a_cell(process, prompt)
        if self.lines:
            line = self.lines.popleft()
            print(f"{prompt}{line}", file=process.stdout or sys.stdout)
        else:
            line = self._answer_of_the_cell(prompt)
        self._last = (self._simulation.now, self._simulation.events)
        return line

    def _let_time_for_typing_pass(self) -> None:
        simulation = self._simulation
        if self._last is not None:
            now, events = self._last
            if simulation.now - now < MOMENT and simulation.events != events:
                simulation.sleep_until(simulation.now + TYPING)

    def _wait_for_a_cell(self, process: Process, prompt: str) -> None:
        """In live mode and between two cells Jupyter shows no prompt: go on in the next cell that lets time pass."""
        if self.live or _is_between_cells():
            asks = f"{process.name} asks {prompt.strip()!r}" if prompt.strip() else f"{process.name} asks for a line"
            print(f"{asks}: to answer, run a cell such as lesson.run(1).", file=process.stdout or sys.stdout)
        while (self.live or _is_between_cells()) and not self.lines:
            self._simulation.sleep_until(self._simulation.now + PAUSE)

    def _answer_of_the_cell(self, prompt: str) -> str:
        """Ask the user, and have the whole world wait for the answer."""
        began, stream = _monotonic(), sys.stdout
        sys.stdout = self._simulation.cell_stdout  # a launched program's would keep the prompt until its line ends
        try:
            return builtins.input(prompt)
        except (OSError, RuntimeError):  # Jupyter's for a page that nobody looks at; Python's without any input
            raise EOFError(END) from None
        finally:
            sys.stdout = stream
            self.seconds_asked += _monotonic() - began


def _is_between_cells() -> bool:
    """Whether this is a notebook in which no cell is running: only to a cell does Jupyter give its own `input`."""
    ipython: Any = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return getattr(shell, "kernel", None) is not None and isinstance(builtins.input, BuiltinFunctionType)
