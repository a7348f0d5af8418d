"""Waits without a time limit that can never end are found at once, and explained.

They are found in two ways. A circle: a thread waits for a lock that only one thread can release, which waits itself, and
so on, back to the first. Or nobody is left: all threads of a process wait without a time limit for one another, so that
none can ever wake another. A thread that sleeps, that spins an executor or that computes might do anything, so as long
as there is one, nothing is said.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ..errors import NeverWakes
from ..strand import Strand
from .hopeless_words import IDLE, why_in_a_circle, why_nobody_is_left

if TYPE_CHECKING:
    from ..process import Process


def look_for_hope(strand: Strand) -> None:
    """Called by a strand that is about to wait without a time limit, its `waits_for` set.

    Raises NeverWakes if that can never end; if the fault is another strand's, it is raised there.
    """
    if _has_it_itself(strand):
        raise NeverWakes(why_in_a_circle(strand, [strand], strand))
    chain = list(_waited_for(strand))
    last = chain[-1]
    owner = _sure_owner(last)
    if owner is not None and (owner.dead or owner in chain):
        raise NeverWakes(why_in_a_circle(strand, chain, owner))
    if _nobody_can_act(strand.process, strand):
        _tell(last if last.waits_for is not IDLE else strand, strand)


def wait_in_vain(strand: Strand, what: str) -> None:
    """Note that a strand waits without a time limit for what only another strand of its process can bring.

    Raises NeverWakes if that can never be. `waits_for` is to be None again when the wait is over.
    """
    strand.waits_for = what
    look_for_hope(strand)


def look_after(ended: Strand) -> None:
    """Called when a strand has ended, or does nothing by itself any more: is there hope for those who wait?"""
    process = ended.process
    waiting = [each for each in living_strands(process) if each.waits_for not in (None, IDLE) and each is not ended]
    if waiting and process.alive and _nobody_can_act(process, ended):
        _tell(list(_waited_for(waiting[0]))[-1], None)


def living_strands(process: Process) -> list[Strand]:
    """The strands of a process that have not ended."""
    return [strand for strand in process.strands if not strand.dead]


def _waited_for(strand: Strand) -> Iterator[Strand]:
    """The strand itself, the one that it surely waits for, the one that that one waits for, and so on."""
    seen: list[Strand] = []
    following: Strand | None = strand
    while following is not None and following not in seen and not following.dead:
        seen.append(following)
        yield following
        owner = _sure_owner(following)
        following = owner if owner is not None and (owner is strand or _waits_in_vain(owner)) else None


def _sure_owner(strand: Strand) -> Strand | None:
    """The only strand that can end the wait of this one, if there is only one."""
    lock = strand.waits_for
    return lock.owner if getattr(lock, "surely", False) else None


def _has_it_itself(strand: Strand) -> bool:
    """Whether a cell waits for a lock that it has taken itself, by `with`, before it let the simulation run."""
    lock = strand.waits_for
    if strand is not strand.simulation.driven or not getattr(lock, "surely", False):
        return False
    return lock.owner is None


def _waits_in_vain(strand: Strand) -> bool:
    if strand.dead or not strand.parked:
        return strand.dead
    return strand.waits_for is not None or (strand.may_act is not None and not strand.may_act())


def _nobody_can_act(process: Process, this: Strand | None) -> bool:
    """Whether all strands of a process, also this one, wait for one another.

    Those who send signals, and the notebook's cells, are somebody, too.
    """
    if any(_is_programs_own(handler) for handler in process.signal_handlers.values()):
        return False
    if process.is_notebook and process.simulation.driven is None:
        return False
    if any(_is_held_outside(strand) for strand in living_strands(process)):
        return False
    return all(strand is this or _waits_in_vain(strand) for strand in process.strands)


def _is_programs_own(handler: Any) -> bool:
    """Whether this handler of a signal was set by the program, and not by `asyncio.run`."""
    return getattr(getattr(handler, "func", None), "__qualname__", "") != "Runner._on_sigint"


def _is_held_outside(strand: Strand) -> bool:
    """Whether somebody who is no strand holds the lock that is waited for."""
    lock: Any = strand.waits_for
    return hasattr(lock, "owner") and lock.owner is None and not strand.process.is_notebook


def _tell(victim: Strand, asking: Strand | None) -> None:
    """Raise NeverWakes where the one waits who is to blame."""
    driven = victim.simulation.driven
    if driven is not None and driven.process is victim.process:
        victim = driven
    if victim is asking:
        raise NeverWakes(why_nobody_is_left(victim))
    victim.simulation.call_later(0, _tell_later, victim)


def _tell_later(victim: Strand) -> None:
    """Called by the hub, at the same instant, but after all that was ready then."""
    if not victim.dead and victim.parked and _nobody_can_act(victim.process, None):
        victim.simulation.raise_in(victim, NeverWakes(why_nobody_is_left(victim)))


__all__ = ["IDLE", "look_after", "look_for_hope", "wait_in_vain"]
