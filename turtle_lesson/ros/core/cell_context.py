"""Each strand has context variables of its own, and yet what it prints goes to the cell that runs the simulation.

`np.errstate`, decimal contexts and asyncio's tasks keep their state in context variables, so strands must not share
them. But Jupyter finds the cell that an output belongs to by context variables, too. So what a later cell has changed
is copied into a strand before it goes on; a variable that the strand has set itself stays its own.
"""

from __future__ import annotations

from contextvars import Context, ContextVar, copy_context
from typing import TYPE_CHECKING, Any

from .strand import greenlet

if TYPE_CHECKING:
    from .strand import Strand

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
        before = context.get(_shown)
        if before is None or before is self:
            return
        changes = [(_shown, self), *self._changes(before, context)]
        visitor = greenlet(_set_all)  # a context in which somebody waits cannot be run in once more, only lived in
        visitor.gr_context = context
        visitor.switch(changes)

    def show_here(self) -> None:
        """The same for the context of the running code."""
        before = _shown.get(None)
        if before is not None and before is not self:
            _set_all([(_shown, self), *self._changes(before, copy_context())])

    def _changes(self, before: Cell, context: Context) -> list[tuple[ContextVar[Any], Any]]:
        return [
            (variable, value)
            for variable, value in self._values.items()
            if (old := before._values.get(variable, _MISSING)) is not value and context.get(variable, _MISSING) is old
        ]


def _set_all(changes: list[tuple[ContextVar[Any], Any]]) -> None:
    for variable, value in changes:
        variable.set(value)


_shown: ContextVar[Cell] = ContextVar("turtle_lesson.cell")
"""Up to which cell a context was kept."""
