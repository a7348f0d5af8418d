"""Loops that do nothing but look, as in `while self.pose is None: pass`, while another thread is to bring what they wait for.

On a robot such a loop burns a processor, and the other thread goes on beside it. Here nobody else goes on before time passes.
So when a program's file is compiled, each round of such a loop is made to take a little time. A program that has but one
thread would wait forever; there the loop is left alone, and is found when it has computed for too long.
"""

from __future__ import annotations

import ast
import re
from typing import Any

from .strand import Strand, getcurrent

NAME = "__another_look__"
"""What the loops call; the builtins of a program have it."""
ROUND = 100_000
"""How long a round takes, in ns."""
_MAY_HAVE_ONE = re.compile(rb"\bwhile\b")
_NOTHING = (ast.Pass, ast.Continue, ast.Break, ast.Return)


def without_busy_loops(source: bytes | str, path: str) -> Any:
    """What to compile instead of a text: itself, or its tree with such loops changed."""
    raw = source.encode("utf-8", "replace") if isinstance(source, str) else source
    if not _MAY_HAVE_ONE.search(raw):
        return source
    tree = ast.parse(source, path)
    busy = [node for node in ast.walk(tree) if isinstance(node, ast.While) and _only_looks(node.body)]
    if not busy:
        return source
    for loop in busy:
        loop.body.insert(0, _look(loop.body[0]))
    return tree


def _only_looks(body: list[ast.stmt]) -> bool:
    return all(
        isinstance(statement, _NOTHING)
        or (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant))
        or (isinstance(statement, ast.If) and _only_looks(statement.body) and _only_looks(statement.orelse))
        for statement in body
    )


def _look(before: ast.stmt) -> ast.stmt:
    """A statement that stands where another one does, so that tracebacks tell the same lines."""
    call = ast.Expr(ast.Call(ast.Name(NAME, ast.Load()), [], []))
    for node in ast.walk(call):
        ast.copy_location(node, before)
    return call


def another_look() -> None:
    """A round of a busy loop: time passes, if there is another thread that could end it."""
    strand = getcurrent()
    if type(strand) is Strand and len(strand.process.strands) > 1:
        strand.simulation.read_clock(ROUND)
