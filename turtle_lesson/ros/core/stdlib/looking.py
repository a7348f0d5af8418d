"""Asking whether something has happened yet.

On a robot, a loop that does nothing but ask, such as `while not future.done(): pass`, burns a processor while other threads
go on. Here nothing else continues before it lets time pass. So polling costs time, as looking at a clock does; but only
for those who ask very often at the same instant, so that the time of all other programs is left as it is.
"""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from ..simulation import CLOCK_READ
from ..strand import Strand, getcurrent
from .home import notebook_here

if TYPE_CHECKING:
    from ..simulation import Simulation

FREE_LOOKS = 1_000
"""After so many looks at one instant, as much time passes as if each had been a look at a clock."""


def looked_in_vain() -> bool:
    """Count a look that found nothing, by a program or by the code of a cell. False, so that one can write `x or …`."""
    strand = getcurrent()
    if type(strand) is Strand:
        count_look(strand.simulation)
    elif (notebook := notebook_here()) is not None:
        count_look(notebook.simulation)
    return False


def count_look(simulation: Simulation) -> None:
    """Count a look, and let time pass if there were too many at this instant."""
    if simulation.looked_at != simulation.now:
        simulation.looked_at, simulation.looks = simulation.now, 0
    simulation.looks += 1
    if simulation.looks > FREE_LOOKS:
        simulation.looks = 0
        simulation.read_clock(FREE_LOOKS * CLOCK_READ)


def is_set(self: threading.Event) -> bool:
    """Return true if and only if the internal flag is true."""
    if self._flag:  # type: ignore[attr-defined]
        return True
    strand = getcurrent()
    if type(strand) is Strand:
        count_look(strand.simulation)
    return False
