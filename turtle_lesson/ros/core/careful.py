"""Parking with care, for simulations in which a program uses asyncio or handles signals.

An asyncio loop that runs is noted in the state of the real thread, which all strands share. So a strand takes that note
along when it parks. And whoever handles signals has its handler called where it waits. Both would slow every switch, so
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
    loop = asyncio._get_running_loop()
    if loop is None:
        type(simulation).park(simulation, strand)
    else:
        _park_beside(loop, simulation, strand)
    while strand.calls:
        function, *strand.calls = strand.calls
        function()


def _park_beside(loop: asyncio.AbstractEventLoop, simulation: Simulation, strand: Strand) -> None:
    """Park in the middle of an asyncio loop that this strand runs."""
    task = asyncio.current_task(loop)
    hooks = sys.get_asyncgen_hooks()
    if task is not None:
        _leave_task(loop, task)
    asyncio._set_running_loop(None)
    sys.set_asyncgen_hooks(None, None)
    try:
        type(simulation).park(simulation, strand)
    finally:
        asyncio._set_running_loop(loop)
        sys.set_asyncgen_hooks(*hooks)
        if task is not None:
            _enter_task(loop, task)


_tasks: Any = asyncio.tasks
_enter_task, _leave_task = _tasks._enter_task, _tasks._leave_task
