"""Messages about waits that can never end: what waits for what, and what to do."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from types import FrameType

from ..strand import Strand, getcurrent

CORE = __name__.rpartition(".")[0].rpartition(".")[0]
_ROOMS = {"threading", "queue", "concurrent.futures.thread", "concurrent.futures._base"}

LOCK = "the lock"
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

_PUBLIC = {"_PySimpleQueue.get": "SimpleQueue.get", "_RLock.acquire": LOCK}

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
    return " ".join([text, *_hint(strand)])


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
        name = frame.f_globals.get("__name__", "")
        if name in _ROOMS:
            found = _PUBLIC.get(frame.f_code.co_qualname, frame.f_code.co_qualname)
        elif name == f"{CORE}.stdlib.locks" and frame.f_code.co_name == "_wait_for_notice":
            found = "Condition.wait"
        elif not name.startswith(CORE):
            break
        frame = frame.f_back
    return found


def _others(strand: Strand) -> str:
    others = [each for each in strand.process.strands if each is not strand and each.waits_for != IDLE]
    waiting = [f"{name_of(each)} waits {_where(wait_of(each))}" for each in others if not each.dead and each.waits_for]
    return f"Its other threads are waiting as well: {', '.join(waiting)}." if waiting else "It has no other thread."


def _where(what: str) -> str:
    return f"in {what}()" if what in _WHAT_ENDS_IT else f"for {what}"


def name_of(strand: Strand) -> str:
    """The name of a thread."""
    from .identity import thread_of

    return str(thread_of(strand).name)


def _hint(strand: Strand) -> list[str]:
    return [text for hint in hints if (text := hint(strand))][:1]
