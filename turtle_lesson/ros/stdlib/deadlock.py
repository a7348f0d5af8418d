"""Deadlocks: waits without a time limit that can never end are found at once, and explained.

They are found in two ways. A circle: a thread waits for a lock that only one thread can release, which waits itself, and so on,
back to the first. Or nobody is left: all threads of a process wait without a time limit for one another, so that none can ever
wake another. A thread that sleeps, that spins an executor or that computes might do anything, so as long as there is one,
nothing is said.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from types import FrameType
from typing import TYPE_CHECKING, Any

from greenlet import getcurrent

from .. import hooks
from ..sim.errors import NeverWakes
from ..sim.run_blocking import LOCK
from ..sim.strand import Strand

if TYPE_CHECKING:
    from ..sim.process import Process


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
    others = [each for each in process.strands if not each.dead and each is not ended]
    waiting = [each for each in others if each.waits_for not in (None, IDLE)]
    if waiting and process.alive and _nobody_can_act(process, ended):
        _tell(list(_waited_for(waiting[0]))[-1], None)


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
    if any(_is_held_outside(strand) for strand in process.strands if not strand.dead):
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


# -- messages: what waits for what, and what to do ---------------------------------------------------------------------

_OURS = (f"{__package__}.", "turtle_lesson.ros.sim.")
_ROOMS = {"threading", "queue", "concurrent.futures.thread", "concurrent.futures._base"}

LOOP = "its asyncio loop"
IDLE = "something to do"
"""For what a worker waits that does nothing by itself: nobody need wake it, and it wakes nobody."""

_WHAT_ENDS_IT = {
    "Barrier.wait": "come to the barrier",
    "Condition.wait": "notify the condition",
    "Condition.wait_for": "notify the condition",
    "Event.wait": "set the event",
    "Future.exception": "complete the future",
    "Future.result": "complete the future",
    "Queue.get": "put anything into the queue",
    "Queue.join": "call task_done() for what is left in the queue",
    "Queue.put": "take anything out of the queue",
    "Semaphore.acquire": "release the semaphore",
    "SimpleQueue.get": "put anything into the queue",
    "Thread.join": "end that thread",
}

_PUBLIC = {
    "VirtualSimpleQueue.get": "SimpleQueue.get",
    "_RLock.acquire": LOCK,
    "_wait_for_notice": "Condition.wait",
    "join": "Thread.join",
}
"""By what a frame's code is called: the documented function that it stands for."""

hints: list[Callable[[Strand], str]] = []
"""Functions that know what to advise a strand that waits for something impossible; the first text that one returns is used."""


def why_nobody_is_left(strand: Strand) -> str:
    """Why a strand would wait forever: because nothing else in its process can do anything."""
    what = wait_of(strand)
    if what == LOOP:
        return (
            "this asyncio loop would wait forever: all of its tasks wait, none of them for a time, and nothing is left in "
            f"this program that could wake one. {_others(strand)}"
        )
    action = _WHAT_ENDS_IT.get(what, "release it" if what == LOCK else "end that")
    text = f"{_never(what)}: nothing is left in this program that could {action}. {_others(strand)}"
    advice = next(filter(None, (hint(strand) for hint in hints)), "")
    return f"{text} {advice}".rstrip()


def why_in_a_circle(strand: Strand, chain: Sequence[Strand], owner: Strand) -> str:
    """Why a strand would wait forever: because the strands that wait for one another form a circle, or one has ended."""
    never = _never(wait_of(strand))
    if owner.dead:
        return f"{never}: {name_of(owner)} has ended without releasing it."
    if owner is strand and len(chain) == 1:
        return (
            f"{never}: this same thread has already taken it. Release it first, or use threading.RLock(), which the "
            "same thread may take again."
        )
    if owner is not strand:
        return f"{never}: {_circle(chain[chain.index(owner) :])}."
    return f"{never}: {_circle(chain)}. If all threads take locks in the same order, that cannot happen."


def _never(what: str) -> str:
    if what in _WHAT_ENDS_IT:
        return f"{what}() would never return"
    return f"waiting for {what} would never end"


def _circle(chain: Sequence[Strand]) -> str:
    following = [*chain[1:], chain[0]]
    pairs = zip(chain, following, strict=True)
    return ", and ".join(f"{name_of(each)} waits for what {name_of(other)} has" for each, other in pairs)


def wait_of(strand: Strand) -> str:
    """What a strand waits for, as it stands in the program: `Queue.get`, `the lock`, `the call of /add`."""
    if isinstance(strand.waits_for, str):
        return strand.waits_for
    frame = sys._getframe(1) if strand is getcurrent() else strand.gr_frame
    called = _called_in(frame)
    if not called and strand is strand.simulation.driven:
        called = _called_in(strand.simulation.hub.gr_frame)  # the cell, for which it waits
    return called or LOCK


def _called_in(frame: FrameType | None) -> str:
    """The function of the rooms of threads that the program has called."""
    found = ""
    while frame is not None:
        name, function = frame.f_globals.get("__name__", ""), frame.f_code.co_qualname
        if name in _ROOMS:
            found = _PUBLIC.get(function, function)
        elif name.startswith(_OURS):
            found = _PUBLIC.get(function, found)
        else:
            break
        frame = frame.f_back
    return found


def _others(strand: Strand) -> str:
    others = [each for each in strand.process.strands if each is not strand and not each.dead]
    waits = [(name_of(each), wait_of(each)) for each in others if each.waits_for not in (None, "", IDLE)]
    waiting = [f"{name} waits {f'in {what}()' if what in _WHAT_ENDS_IT else f'for {what}'}" for name, what in waits]
    return f"Its other threads are waiting as well: {', '.join(waiting)}." if waiting else "It has no other thread."


def name_of(strand: Strand) -> str:
    """The name of a thread."""
    return str(hooks.thread_of(strand).name)
