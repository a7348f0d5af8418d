"""A question on a page, and the guess: buttons for choices, a field for a number, a map for a point."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import traitlets

from ..recording import WORLD
from .backend import Link, Loop
from .live_widget import LiveWidget

if TYPE_CHECKING:
    from ..predictions import Question


class PredictionWidget(LiveWidget):
    """Needs no system: its backend is only the notebook's loop, and never ends."""

    SCRIPTS = ("dom", "small", "map", "prediction")
    STYLES = ("base", "small", "prediction")

    question = traitlets.Unicode().tag(sync=True)
    kind = traitlets.Unicode().tag(sync=True)
    """"choice", "number" or "point"."""
    choices = traitlets.List(traitlets.Unicode()).tag(sync=True)
    unit = traitlets.Unicode().tag(sync=True)
    world = traitlets.Float(WORLD).tag(sync=True)
    """Side of the map, m."""
    turtle: Any = traitlets.List(None, allow_none=True).tag(sync=True)
    """Where the turtle stands, x, y (m) and theta (rad), or None."""
    goal: Any = traitlets.Dict(None, allow_none=True).tag(sync=True)
    """Where it is to go: x, y (m) and theta (rad or None), or None."""
    guess: Any = traitlets.Any(None, allow_none=True).tag(sync=True)
    """The guess as it was recorded: a text, a number, [x, y], or None."""
    is_open = traitlets.Bool(True).tag(sync=True)
    """Whether a guess can still be given."""

    def __init__(self, question: Question) -> None:
        self._asked = question
        backend = Link(SimpleNamespace(loop=Loop(), ended=False))
        kind = question.kind
        super().__init__(
            backend,
            question=question.question,
            kind=type(kind).__name__.lower(),
            choices=list(getattr(kind, "choices", ())),
            unit=getattr(kind, "unit", ""),
        )
        self.tick()

    def tick(self) -> None:
        """Show what was recorded, also by another view or by code."""
        guess = self._asked.guess
        self.turtle = list(self._asked.turtle) if self._asked.turtle else None
        self.goal = self._asked.goal._asdict() if self._asked.goal else None
        self.guess = list(guess) if isinstance(guess, tuple) else guess
        self.is_open = self._asked.open

    def do_guess(self, value: Any) -> None:
        """Record a guess."""
        self._asked.answer(value)
        self.words = (
            f"Recorded: {self._asked.kind.shown(self._asked.guess)}. You can change it until the outcome is shown."
        )

    def _text(self) -> str:
        return repr(self._asked)
