"""Programs that wait for ever, and programs that poll.

A wait without a time limit that can never end (a deadlock) is found at once, and explained. There are two kinds. A circle: a
thread waits for a lock that only one thread can release, which waits itself, and so on, back to the first. Or nobody is left:
all threads of a process wait without a time limit for one another, so that none can ever wake another. A thread that sleeps,
spins an executor or computes might do anything, so as long as there is one, nothing is said.
"""

from __future__ import annotations

import ast
import sys
import threading
from collections.abc import Callable, Sequence
from types import FrameType
from typing import TYPE_CHECKING, Any

from .. import hooks
from ..sim.errors import NeverWakes
from ..sim.run_blocking import LOCK
from ..sim.simulation import CLOCK_READ
from ..sim.strand import Strand, running_strand
from .ownership import notebook_here

if TYPE_CHECKING:
    from ..sim.process import Process
    from ..sim.simulation import Simulation
    from .locks import VirtualLock


def wait_in_vain(strand: Strand, what: VirtualLock | str) -> None:
    """Note that a strand waits without a time limit for a lock, or for what only another strand of its process can bring.

    Raises NeverWakes if that can never be; if the fault is another strand's, it is raised there. `waits_for` is to be None
    again when the wait is over.
    """
    strand.waits_for = what
    if strand is strand.simulation.driven and not isinstance(what, str) and what.surely and what.owner is None:
        # a cell waits for a lock that it has taken itself, by `with`, before it let the simulation run
        raise NeverWakes(why_in_a_circle(strand, [strand], strand))
    chain = _chain(strand)
    last = chain[-1]
    owner = _sure_owner(last)
    if owner is not None and (owner.dead or owner in chain):
        raise NeverWakes(why_in_a_circle(strand, chain, owner))
    if _nobody_can_act(strand.process, strand):
        _tell(last if last.waits_for is not IDLE else strand, strand)


def look_after(ended: Strand) -> None:
    """Called when a strand has ended, or does nothing by itself any more: looks for others that now wait in vain."""
    process = ended.process
    others = [each for each in process.strands if not each.dead and each is not ended]
    waiting = [each for each in others if each.waits_for not in (None, IDLE)]
    if waiting and process.alive and _nobody_can_act(process, ended):
        _tell(_chain(waiting[0])[-1], None)


def _chain(strand: Strand) -> list[Strand]:
    """The strand itself, the one that it surely waits for, the one that that one waits for, and so on."""
    chain: list[Strand] = []
    following: Strand | None = strand
    while following is not None and following not in chain and not following.dead:
        chain.append(following)
        owner = _sure_owner(following)
        following = owner if owner is not None and (owner is strand or _waits_in_vain(owner)) else None
    return chain


def _sure_owner(strand: Strand) -> Strand | None:
    """The only strand that can end the wait of this one, if there is only one."""
    lock = strand.waits_for
    return lock.owner if getattr(lock, "surely", False) else None


def _waits_in_vain(strand: Strand) -> bool:
    if strand.dead or not strand.parked:
        return strand.dead
    return strand.waits_for is not None or (strand.may_act is not None and not strand.may_act())


def _nobody_can_act(process: Process, this: Strand | None) -> bool:
    """Whether all strands of a process, also this one, wait for one another.

    A signal that the program handles can end a wait, too, and so can the notebook's next cell.
    """
    handlers = [getattr(each, "func", each) for each in process.signal_handlers.values() if callable(each)]
    names = {getattr(each, "__qualname__", "") for each in handlers}
    if names - {"default_int_handler", "Runner._on_sigint"}:  # set by the program, and not by Python or `asyncio.run`
        return False
    if process.is_notebook and process.simulation.driven is None:
        return False
    for each in process.strands:
        if not each.dead and getattr(each.waits_for, "owner", each) is None and not process.is_notebook:
            return False  # the lock that it waits for is held outside of all strands
    return all(strand is this or _waits_in_vain(strand) for strand in process.strands)


def _tell(victim: Strand, asking: Strand | None) -> None:
    """Raise NeverWakes in the strand that is to blame."""
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
"""What an idle worker waits for: it is no deadlock if nothing wakes it, and it wakes no other thread."""

_PUBLIC = {"_PySimpleQueue.get": "SimpleQueue.get()", "_RLock.acquire": LOCK, "join": "Thread.join()"}
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
    text = f"waiting for {what} would never end: nothing is left in this program that could end it. {_others(strand)}"
    advice = next(filter(None, (hint(strand) for hint in hints)), "")
    return f"{text} {advice}".rstrip()


def why_in_a_circle(strand: Strand, chain: Sequence[Strand], owner: Strand) -> str:
    """Why a strand would wait forever: because the strands that wait for one another form a circle, or one has ended."""
    never = f"waiting for {wait_of(strand)} would never end"
    if owner.dead:
        return f"{never}: {_name(owner)} has ended without releasing it."
    if owner is strand and len(chain) == 1:
        return (
            f"{never}: this same thread has already taken it. Release it first, or use threading.RLock(), which the "
            "same thread may take again."
        )
    circle = chain[chain.index(owner) :]
    following = [*circle[1:], owner]
    waits = [f"{_name(each)} waits for what {_name(other)} has" for each, other in zip(circle, following, strict=True)]
    return f"{never}: {', and '.join(waits)}. If all threads take locks in the same order, that cannot happen."


def wait_of(strand: Strand) -> str:
    """What a strand waits for, as it stands in the program: `Queue.get()`, `the lock`, `the call of /add`."""
    if isinstance(strand.waits_for, str):
        return strand.waits_for
    frame = sys._getframe(1) if strand is running_strand() else strand.frame
    called = _called_in(frame)
    if not called and strand is strand.simulation.driven:
        called = _called_in(strand.simulation.hub.gr_frame)  # the cell, for which it waits
    return called or LOCK


def _called_in(frame: FrameType | None) -> str:
    """The function of the rooms of threads that the program has called."""
    found = ""
    while frame is not None:
        name, function = frame.f_globals.get("__name__", ""), frame.f_code.co_qualname
        if name in _ROOMS and function not in ("Thread.run", "_worker"):  # by which a pool's thread came there
            found = _PUBLIC.get(function, f"{function}()")
        elif name.startswith(_OURS):
            found = _PUBLIC.get(function, found)
        else:
            break
        frame = frame.f_back
    return found


def _others(strand: Strand) -> str:
    others = [each for each in strand.process.strands if each is not strand and not each.dead]
    waiting = [f"{_name(each)} waits for {wait_of(each)}" for each in others if each.waits_for not in (None, IDLE)]
    return f"Its other threads are waiting as well: {', '.join(waiting)}." if waiting else "It has no other thread."


def _name(strand: Strand) -> str:
    return str(hooks.thread_of(strand).name)


# -- polling -----------------------------------------------------------------------------------------------------------
# Programs that ask again and again whether something has happened; robot time goes on meanwhile. On a robot, a loop
# that does nothing but ask, such as `while not future.done(): pass`, burns a processor while other threads go on. Here
# nothing else continues before time passes. So polling costs time, as looking at a clock does; but only for those who
# ask very often at the same instant, so that the time of all other programs is left as it is.
#
# A loop that asks nobody, as `while self.pose is None: pass`, is changed when a program's file is compiled: each of its
# rounds takes a little time. A program that has but one thread would wait forever; there the loop is left alone, and is
# found when it has computed for too long.

FREE_LOOKS = 1_000
"""After so many looks at one instant, as much time passes as if each had been a look at a clock."""


def looked_in_vain() -> bool:
    """Count a look that found nothing, by a program or by the code of a cell. False, so that one can write `x or …`."""
    strand = running_strand()
    if strand is not None:
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
    strand = running_strand()
    if strand is not None:
        count_look(strand.simulation)
    return False


NAME = "__another_look__"
"""What the loops call; the builtins of a program have it."""
ROUND = 100_000
"""How long a round takes, in ns."""
_NOTHING = (ast.Pass, ast.Continue, ast.Break, ast.Return)


def without_busy_loops(source: bytes | str, path: str) -> Any:
    """What to compile instead of a text: itself, or its tree with such loops changed."""
    if b"while" not in (source.encode(errors="replace") if isinstance(source, str) else source):
        return source  # to parse a program takes longer than to compile it
    tree = ast.parse(source, path)
    busy = [node for node in ast.walk(tree) if isinstance(node, ast.While) and _only_looks(node.body)]
    for loop in busy:
        line = loop.body[0].lineno  # of the first statement, so that tracebacks tell the same lines
        loop.body[:0] = ast.parse("\n" * (line - 1) + f"{NAME}()").body
    return tree if busy else source


def _only_looks(body: list[ast.stmt]) -> bool:
    return all(
        isinstance(statement, _NOTHING)
        or (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant))
        or (isinstance(statement, ast.If) and _only_looks(statement.body) and _only_looks(statement.orelse))
        for statement in body
    )


def another_look() -> None:
    """A round of a busy loop: time passes, if there is another thread that could end it."""
    strand = running_strand()
    if strand is not None and len(strand.process.strands) > 1:
        strand.simulation.read_clock(ROUND)
