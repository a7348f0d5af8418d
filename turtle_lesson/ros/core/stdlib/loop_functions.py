"""Which asyncio loop is whose: each thread of a simulated process has its own, as in Python."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from typing import Any

from ..strand import Strand, running_strand
from .loops import VirtualEventLoop


def new_event_loop(real: Any) -> Any:
    """A new loop: in a simulated process one that waits in virtual time."""
    strand = running_strand()
    return real() if strand is None else VirtualEventLoop(strand.process)


def set_event_loop(real: Any, loop: Any) -> None:
    """Set the loop of the running thread."""
    strand = running_strand()
    if strand is None:
        real(loop)
    else:
        _loops(strand)[strand] = loop


def get_event_loop(real: Any) -> Any:
    """The loop that runs, or else that of the running thread; in a main thread one is made where there is none."""
    strand = running_strand()
    if strand is None:
        return real()
    loop = asyncio._get_running_loop()
    if loop is not None:
        return loop
    loops = _loops(strand)
    if strand is strand.process.main_strand and strand not in loops:
        loops[strand] = VirtualEventLoop(strand.process)
    if loops.get(strand) is None:
        name = threading.current_thread().name
        raise RuntimeError(f"There is no current event loop in thread {name!r}.")
    return loops[strand]


def _loops(strand: Strand) -> dict[Strand, Any]:
    return strand.process.locals.setdefault("asyncio.loops", {})


REPLACEMENTS: tuple[Callable[..., Any], ...] = (new_event_loop, set_event_loop, get_event_loop)
