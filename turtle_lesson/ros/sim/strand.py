"""A strand: one line of execution in a simulated process, and what Python sees while it runs: context, argv, streams."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Sequence
from contextvars import Context, ContextVar, copy_context
from types import FrameType
from typing import TYPE_CHECKING, Any

from greenlet import GreenletExit, greenlet
from greenlet import getcurrent as running_greenlet

if TYPE_CHECKING:
    from ..stdlib.program import ProgramModules
    from .process import Process
    from .simulation import Simulation

__all__ = ["Carrier", "GreenletExit", "Strand", "greenlet", "running_greenlet", "running_strand"]

PATIENCE = 3
"""How often a call that does not want to end is told to, when its world closes."""

undead: list[greenlet] = []
"""Those that did not end then. They are kept: one that Python collects would be unwound in the middle of any other code, and
would take the notebook's event loop for its own."""


# -- strand -------------------------------------------------------------------------------------------------------
# A strand: one line of execution in a simulated process, which can stop in the middle of a call and go on later.
# It is a greenlet (https://greenlet.readthedocs.io).
# A strand is *parked* (waits until somebody wakes it), *ready* (queued to go on at this instant), *running* or
# *dead*. The hub is the greenlet that runs the simulation's loop: the notebook cell itself.
# A strand that spins an executor does the same each time that it is woken: it takes a *turn*. To switch to its stack for
# that would cost more than most callbacks, so a carrier takes the turns of all such strands on one stack, its own. Only
# where a callback waits does that stack become the strand's, until the turn is over; another carrier then does the work.


class Strand(greenlet):
    """One line of execution of a process: its main program, a thread, or a worker of a multi-threaded executor.

    Attributes:
        process: the process that it belongs to.
        simulation: that process's simulation.
        parked: whether it waits to be woken.
        activity: what it does, for messages that explain why it takes so long.
        warned: whether it was told once that it computes without end.
        frozen_at: the virtual time (ns) at which it was last frozen in the middle of a computation; -1 before that.
        cell: the cell that it prints to.
        waits_for: what it waits for without a time limit, and without end if all others of its process do so; None otherwise.
        may_act: asks whether anything that it waits for could have it go on; None if that is not known.
        name: what it is called, if nobody gives it another name.
        thread: the `threading.Thread` that it is, once somebody has asked.
        calls: functions to be called in it where it waits, such as handlers of signals.
        body: the greenlet on whose stack it stopped; None while it waits for turns, which any carrier takes.
        turn: what it does in a turn; it returns whether the strand waits for another one.
        context: its context variables, while it waits for turns.
        failure: what its last turn has raised, until it goes on itself.
    """

    __slots__ = (  # each switch reads some of them, and the dictionary of a greenlet is slow
        "activity",
        "body",
        "calls",
        "cell",
        "context",
        "failure",
        "frozen_at",
        "may_act",
        "name",
        "parked",
        "process",
        "simulation",
        "thread",
        "turn",
        "waits_for",
        "warned",
    )

    def __init__(self, process: Process, target: Callable[[], Any]) -> None:
        super().__init__(target)
        self.process = process
        self.simulation: Simulation = process.simulation
        self.parked = False
        self.activity = ""
        self.warned = False
        self.frozen_at = -1
        self.cell: Cell | None = None
        self.waits_for: Any = None
        self.may_act: Callable[[], bool] | None = None
        self.name = ""
        self.thread: Any = None
        self.calls: Sequence[Callable[[], object]] = ()
        self.body: greenlet | None = self
        self.turn: Any = None
        self.context: Context | None = None
        self.failure: BaseException | None = None
        self.parent = process.simulation.hub  # type: ignore[misc]
        process.simulation.strands.add(self)

    def park(self) -> None:
        """Stop here until woken. May also return early: callers check what they wait for, in a loop."""
        self.simulation.park(self)

    def own_body(self) -> greenlet:
        """The greenlet on whose stack it stopped, for the hub to have it go on, or an error raised there."""
        self.parked = False
        if self.body is None:
            self.body = self
        self.parent = self.body.parent = self.simulation.hub
        return self.body

    @property
    def frame(self) -> FrameType | None:
        """The innermost call in which it has stopped."""
        return self.gr_frame if self.body is None else self.body.gr_frame


class Carrier(greenlet):
    """A stack on which turns are taken. `strand` is the one whose turn it is; None while it does nothing."""

    __slots__ = ("strand",)

    def __init__(self, target: Callable[[], Any]) -> None:
        super().__init__(target)
        self.strand: Strand | None = None


def running_strand() -> Strand | None:
    """The strand that runs now, or None in plain Python code such as a notebook cell."""
    current = running_greenlet()
    if type(current) is Carrier:
        return current.strand
    return current if type(current) is Strand else None


# -- cell context -------------------------------------------------------------------------------------------------
# Each strand has context variables of its own, and yet what it prints goes to the cell that runs the simulation.
# `np.errstate`, decimal contexts and asyncio's tasks keep their state in context variables, so strands must not share
# them. But Jupyter finds the cell that an output belongs to by context variables, too. So what a later cell has
# changed is copied into a strand before it goes on; a variable that the strand has set itself stays its own.

_MISSING = object()


class Cell:
    """The context variables of a cell that runs the simulation."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._values = dict(context.items())

    def now(self) -> Cell:
        """The cell that runs now: this one, if no variable has changed since."""
        context = copy_context()
        before = self._values
        if len(context) == len(before):
            for variable, value in context.items():
                if before.get(variable, _MISSING) is not value:
                    break
            else:
                return self
        return Cell(context)

    def show_to(self, strand: Strand) -> None:
        """Have the strand, which is about to go on, print to this cell."""
        strand.cell = self
        context = strand.gr_context if strand else None
        if context is None:  # it is about to begin
            strand.gr_context = context = self._context.copy()
            context.run(_shown.set, self)
        else:
            self.show_in(context)

    def show_in(self, context: Context) -> None:
        """Copy what has changed since an earlier cell into a context that came from that one."""
        # a context in which somebody waits cannot be run in once more, only lived in
        visitor = greenlet(self.show_here)
        visitor.gr_context = context
        visitor.switch()

    def show_here(self) -> None:
        """The same for the context of the running code."""
        before = _shown.get(None)
        if before is None or before is self:
            return
        for variable, value in self._values.items():
            old = before._values.get(variable, _MISSING)
            if old is not value and variable.get(_MISSING) is old:
                variable.set(value)
        _shown.set(self)


_shown: ContextVar[Cell] = ContextVar("turtle_lesson.cell")
"""Up to which cell a context was kept."""


# -- face ---------------------------------------------------------------------------------------------------------
# What a running process shows to Python: `sys.argv`, `sys.stdout`, `sys.stderr`, and its modules while it imports.
# They are changed when another process goes on, and are the cell's again when the cell goes on.

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


# -- asyncio ------------------------------------------------------------------------------------------------------
# The asyncio loop that runs is noted in the state of the real thread, which all strands share.


class LoopAside:
    """While others go on, put aside the asyncio loop that runs here, with its task and its care for generators."""

    def __enter__(self) -> None:
        self.loop, self.hooks = asyncio._get_running_loop(), sys.get_asyncgen_hooks()
        self.task = None if self.loop is None else asyncio.current_task(self.loop)
        if self.loop is not None and self.task is not None:
            asyncio._leave_task(self.loop, self.task)
        asyncio._set_running_loop(None)
        sys.set_asyncgen_hooks(None, None)

    def __exit__(self, *error: object) -> None:
        asyncio._set_running_loop(self.loop)
        sys.set_asyncgen_hooks(*self.hooks)
        if self.loop is not None and self.task is not None:
            asyncio._enter_task(self.loop, self.task)
