"""Parking with care, for simulations in which a program uses asyncio or handles signals.

An asyncio loop that runs is noted in the state of the real thread, which all strands share. So a strand takes that note
along when it parks. And a process that handles signals has its handler called where it waits. Both would slow every switch, so
a simulation begins to park like this when it is first needed.
"""

from __future__ import annotations

import asyncio
import sys
from types import MethodType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .simulation import Simulation
    from .strand import Strand


def be_careful(simulation: Simulation) -> None:
    """Let all strands of a simulation park with care from now on."""
    if "park" not in vars(simulation):
        simulation.park = MethodType(_park, simulation)  # type: ignore[method-assign]


def _park(simulation: Simulation, strand: Strand) -> None:
    if asyncio._get_running_loop() is None:
        type(simulation).park(simulation, strand)
    else:
        with LoopAside():
            type(simulation).park(simulation, strand)
    while strand.calls:
        function, *strand.calls = strand.calls
        function()


class LoopAside:
    """While others go on, put aside the asyncio loop that runs here, with its task and its care for generators."""

    def __enter__(self) -> None:
        self.loop, self.hooks = asyncio._get_running_loop(), sys.get_asyncgen_hooks()
        self.task = None if self.loop is None else asyncio.current_task(self.loop)
        if self.loop is not None and self.task is not None:
            _leave_task(self.loop, self.task)
        asyncio._set_running_loop(None)
        sys.set_asyncgen_hooks(None, None)

    def __exit__(self, *error: object) -> None:
        asyncio._set_running_loop(self.loop)
        sys.set_asyncgen_hooks(*self.hooks)
        if self.loop is not None and self.task is not None:
            _enter_task(self.loop, self.task)


_tasks: Any = asyncio.tasks
_enter_task, _leave_task = _tasks._enter_task, _tasks._leave_task
