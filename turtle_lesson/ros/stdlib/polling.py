"""Programs that poll: they ask again and again whether something has happened, and robot time goes on meanwhile.

On a robot, a loop that does nothing but ask, such as `while not future.done(): pass`, burns a processor while other threads go
on. Here nothing else continues before time passes. So polling costs time, as looking at a clock does; but only for those who
ask very often at the same instant, so that the time of all other programs is left as it is.

A loop that asks nobody, as `while self.pose is None: pass`, is changed when a program's file is compiled: each of its rounds
takes a little time. A program that has but one thread would wait forever; there the loop is left alone, and is found when it
has computed for too long.
"""

from __future__ import annotations

import ast
import re
import threading
from typing import TYPE_CHECKING, Any

from greenlet import getcurrent

from ..sim.simulation import CLOCK_READ
from ..sim.strand import Strand
from .ownership import notebook_here

if TYPE_CHECKING:
    from ..sim.simulation import Simulation


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


NAME = "__another_look__"
"""What the loops call; the builtins of a program have it."""
ROUND = 100_000
"""How long a round takes, in ns."""
_WHILE = re.compile(rb"(?:^|[\r\n]|\xef\xbb\xbf)[ \t\f]*while\b")
"""A line that may begin with a `while`, as such a statement must: to parse a program takes longer than to compile it."""
_NOTHING = (ast.Pass, ast.Continue, ast.Break, ast.Return)


def without_busy_loops(source: bytes | str, path: str) -> Any:
    """What to compile instead of a text: itself, or its tree with such loops changed."""
    if not _WHILE.search(source if isinstance(source, bytes) else source.encode(errors="replace")):
        return source
    tree = ast.parse(source, path)
    busy = [node for node in _statements(tree) if isinstance(node, ast.While) and _only_looks(node.body)]
    if not busy:
        return source
    for loop in busy:
        look = ast.Expr(ast.Call(ast.Name(NAME, ast.Load()), [], []))
        for node in ast.walk(look):  # it stands where the first statement does, so that tracebacks tell the same lines
            ast.copy_location(node, loop.body[0])
        loop.body.insert(0, look)
    return tree


def _statements(tree: ast.Module) -> list[ast.AST]:
    """All statements, without the expressions in them: those are most of a tree."""
    found: list[ast.AST] = [tree]
    for node in found:
        for part in ("body", "orelse", "finalbody", "handlers", "cases"):
            found += getattr(node, part, ())
    return found


def _only_looks(body: list[ast.stmt]) -> bool:
    return all(
        isinstance(statement, _NOTHING)
        or (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant))
        or (isinstance(statement, ast.If) and _only_looks(statement.body) and _only_looks(statement.orelse))
        for statement in body
    )


def another_look() -> None:
    """A round of a busy loop: time passes, if there is another thread that could end it."""
    strand = getcurrent()
    if type(strand) is Strand and len(strand.process.strands) > 1:
        strand.simulation.read_clock(ROUND)
