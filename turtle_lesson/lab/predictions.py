"""Predictions: a reader's guess before something is run, and afterwards guess and outcome side by side.

Guesses live as long as the kernel. They are in no file, so that a page says the same whenever it is run from its top.
"""

from __future__ import annotations

import html
import math
import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from numbers import Real
from typing import TYPE_CHECKING, Any

from . import drawing
from .path import TOLERANCE, Goal, Place
from .recording import WORLD
from .words import listed, number, point, suggestion

if TYPE_CHECKING:
    from .widgets.prediction import PredictionWidget

NO_GUESS = "no guess yet"

TYPED = re.compile(r"\s*([+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:e[+-]?\d+)?)\s*(.*?)\s*", re.I)
"""A number and its unit, as they are typed."""


@dataclass(frozen=True)
class Choice:
    """One of several texts."""

    choices: tuple[str, ...]

    def read(self, value: Any) -> str:
        """One of the texts, letter by letter."""
        if value not in self.choices:
            raise ValueError(f"{value!r} is not among the choices: {listed([repr(each) for each in self.choices])}.")
        return value

    def shown(self, value: Any) -> str:
        """The text."""
        return str(value)

    def compared(self, guess: Any, value: Any) -> str:
        """Right, or not."""
        return "That is right." if guess == value else "The outcome is different: why?"


@dataclass(frozen=True)
class Number:
    """A number with a unit."""

    unit: str

    def read(self, value: Any) -> float:
        """A finite number; what was typed may have its unit, a decimal comma and a true minus sign."""
        asked = f"A number{f' in {self.unit}' if self.unit else ''} is asked for, got {value!r}"
        if not isinstance(value, str):
            if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
                raise ValueError(f"{asked}.")
            return float(value)
        found = TYPED.fullmatch(value.replace("−", "-"))
        if found is None or not math.isfinite(given := float(found[1].replace(",", "."))):
            raise ValueError(f"{asked}. Write it like 2.5{f' or 2.5 {self.unit}' if self.unit else ''}.")
        names = {each.casefold().removesuffix("s") for each in ("", self.unit, *SPELT.get(self.unit, ()))}
        if found[2].casefold().removesuffix("s") not in names:
            raise ValueError(f"{asked}: {found[2]!r} is not understood. Write only the number.")
        return given

    def shown(self, value: Any) -> str:
        """The number, with at most three decimals, and its unit."""
        text = number(value, 3).rstrip("0").rstrip(".")
        return f"{text} {self.unit}".rstrip()

    def compared(self, guess: Any, value: Any) -> str:
        """The difference, and its share of the true value."""
        off = abs(guess - value)
        if self.shown(guess) == self.shown(value):
            return "That is right."
        share = f", {number(100 * off / abs(value), 0)} %" if value else ""
        return f"{self.shown(off)} off{share}."


@dataclass(frozen=True)
class Point:
    """A place on the turtle's map, m."""

    def read(self, value: Any) -> tuple[float, float]:
        """Two finite numbers, the first two of a longer tuple, or what has x and y."""
        if hasattr(value, "x") and hasattr(value, "y"):
            value = (value.x, value.y)
        with suppress(TypeError, ValueError):
            x, y = (float(each) for each in tuple(value)[:2])
            if math.isfinite(x) and math.isfinite(y):
                return x, y
        raise ValueError(f"A point is two finite numbers in metres, such as (8, 3), got {value!r}.")

    def shown(self, value: Any) -> str:
        """Both, with their unit."""
        return f"{point(*value)} m"

    def compared(self, guess: Any, value: Any) -> str:
        """How far apart they are."""
        return f"{number(math.dist(guess, value))} m off."


Kind = Choice | Number | Point
"""What is guessed: it reads values, says them in words, and compares two."""

SPELT = {"s": ("second",), "m": ("metre", "meter"), "Hz": ("times a second",), "%": ("percent",), "°": ("degree",)}
"""How units may be written beside their signs, in the singular."""


def kind_of(choices: Sequence[str], unit: str | None, on_map: bool) -> Kind:
    """What is guessed. Raises ValueError unless just one of the three is given."""
    if [bool(choices), unit is not None, on_map].count(True) != 1:
        raise ValueError(
            'give just one of choices=["…", "…"], unit="m" (a number; "" for none) and on_map=True (a point), so that '
            "a guess can be recorded"
        )
    if choices:
        return Choice(tuple(map(str, choices)))
    return Point() if on_map else Number(str(unit))


@dataclass(repr=False)
class Question:
    """A question, the guess (None as long as there is none) and the outcome (None until it is told).

    It is what `lesson.predict` gives: in a notebook a small widget, everywhere else a sentence.
    """

    name: str
    question: str
    kind: Kind
    turtle: tuple[float, float, float] | None = None
    """Where the turtle stands while the question is open: x, y (m), theta (rad)."""
    goal: Goal | None = None
    """Where it is to go."""
    guess: Any = None
    outcome: Any = None
    _widget: PredictionWidget | None = None

    @property
    def open(self) -> bool:
        """Whether the outcome is not known yet, so that a guess is one."""
        return self.outcome is None

    def answer(self, guess: Any) -> None:
        """Record a guess. Raises ValueError for what it cannot be, and when the outcome is known."""
        if not self.open:
            raise ValueError("The outcome is already known. Run the question's cell again to make a new guess.")
        self.guess = self.kind.read(guess)

    def __repr__(self) -> str:
        guess = f"your guess: {self.kind.shown(self.guess)}" if self.guess is not None else NO_GUESS
        options = f" ({' / '.join(self.kind.choices)})" if isinstance(self.kind, Choice) else ""
        return f"{self.question}{options} – {guess}."

    @property
    def widget(self) -> PredictionWidget:
        """The widget on which the guess is given, the same one wherever the question is asked again."""
        if self._widget is None or self._widget.comm is None:
            from .widgets.prediction import PredictionWidget

            self._widget = PredictionWidget(self)
        return self._widget

    def _repr_mimebundle_(self, **options: Any) -> Any:
        return self.widget._repr_mimebundle_(**options)


_questions: dict[str, Question] = {}


def ask(
    name: str,
    question: str,
    kind: Kind,
    guess: Any = None,
    *,
    turtle: tuple[float, float, float] | None = None,
    goal: Goal | None = None,
) -> Question:
    """Put a question, or show it again. One whose outcome is known, or whose words have changed, begins anew.

    A map shows the turtle where it stands, and its goal, if there is one.
    """
    found = _questions.get(name)
    if found is None or not found.open or (found.question, found.kind) != (question, kind):
        if found is not None and found._widget is not None:
            from .widgets.live_widget import put_aside

            put_aside(found._widget)
        found = _questions[name] = Question(name, question, kind)
    found.turtle, found.goal = turtle, goal
    if guess is not None:
        found.answer(guess)
    return found


def tell(name: str, value: Any) -> Outcome:
    """Say what came of it. Raises ValueError for a name that was never asked, and for a value that the question cannot have."""
    if name not in _questions:
        begin = f"no question was asked under the name {name!r}."
        raise ValueError(f"{begin} {suggestion(str(name), _questions)} Run the cell with lesson.predict first.")
    found = _questions[name]
    found.outcome = found.kind.read(value)
    return Outcome(found)


class Outcome:
    """Guess and outcome side by side."""

    def __init__(self, question: Question) -> None:
        kind = question.kind
        self.title = question.question
        self.guess = kind.shown(question.guess) if question.guess is not None else NO_GUESS
        self.outcome = kind.shown(question.outcome)
        self.verdict = kind.compared(question.guess, question.outcome) if question.guess is not None else ""
        self._map = ""
        if isinstance(kind, Point):
            self._map = draw_map(question.turtle, question.goal, question.guess, question.outcome)

    def __repr__(self) -> str:
        lines = [self.title, f"  your guess: {self.guess}", f"  outcome:    {self.outcome}"]
        return "\n".join([*lines, f"  {self.verdict}"] if self.verdict else lines)

    def _repr_html_(self) -> str:
        cell = 'style="text-align: left; vertical-align: top; white-space: normal"'
        cells = "".join(f"<td {cell}><strong>{html.escape(each)}</strong></td>" for each in (self.guess, self.outcome))
        return (
            f"<p>{html.escape(self.title)}</p><table><thead><tr><th {cell}>your guess</th><th {cell}>outcome</th></tr></thead>"
            f"<tbody><tr>{cells}</tr></tbody></table>{self._map}<p>{html.escape(self.verdict)}</p>"
        )


SCALE, SIDE, KEY = 24.0, WORLD * 24.0, 22.0
"""Pixels a metre, of the world's side, and a line of the key."""
LEFT, TOP, RIGHT, BOTTOM = 40.0, 14.0, 18.0, 42.0
"""Pixels around the world: a mark at a wall is not cut."""


def draw_map(turtle: tuple[float, float, float] | None, goal: Goal | None, guess: Place | None, outcome: Place) -> str:
    """Return the map as an element of HTML; its alternative text says what is where."""
    signs: list[tuple[str, str, str]] = []  # on the map, in the key, and in words
    if turtle is not None:
        there = drawing.turtle(*_pixels(turtle[:2]), turtle[2], SCALE)
        signs.append((there, drawing.turtle(0, 0, 0, 18), f"start {point(*turtle[:2])} m"))
    if goal is not None:
        signs.append((_flag(*_pixels(goal), SCALE), _flag(-2, 6, 16), f"goal {point(*goal[:2])} m"))
    if guess is not None:
        ring = f'fill="none" stroke="{drawing.BLUE}" stroke-width="3"'
        signs.append((_disc(*_pixels(guess), 8, ring), _disc(0, 0, 8, ring), f"your guess {point(*guess)} m"))
    full = f'fill="{drawing.PURPLE}"'
    signs.append((_disc(*_pixels(outcome), 6, full), _disc(0, 0, 6, full), f"outcome {point(*outcome)} m"))
    parts = _axes()
    if guess is not None:
        parts.append(_line(*_pixels(guess), *_pixels(outcome), drawing.INK, 'stroke-dasharray="4 4"'))
    parts += [on_map for on_map, _, _ in signs]
    top = TOP + SIDE + BOTTOM
    for row, (_, sign, words) in enumerate(signs):
        y = top + KEY * (row + 0.5)
        parts.append(f'<g transform="translate({LEFT + 10:g} {number(y, 1)})">{sign}</g>')
        parts.append(drawing.text(LEFT + 28, y + 4, words, 13, "start"))
    description = f"Map of the turtle's world: {'; '.join(words for _, _, words in signs)}."
    width, height = round(LEFT + SIDE + RIGHT), round(top + KEY * len(signs) + 4)
    return drawing.image(drawing.document(width, height, "Guess and outcome", description, parts), description)


def _pixels(place: tuple[float, ...] | Goal) -> Place:
    """A place on the drawing; one beyond the walls is shown at the wall."""
    x, y = (max(0.0, min(WORLD, float(each or 0.0))) for each in place[:2])
    return LEFT + x * SCALE, TOP + (WORLD - y) * SCALE


def _axes() -> list[str]:
    """The walls, a line at each metre, and figures at every second one."""
    parts = []
    for metre in range(1, int(WORLD) + 1):
        x, y = _pixels((metre, metre))
        parts += [_line(x, TOP, x, TOP + SIDE, drawing.LINE), _line(LEFT, y, LEFT + SIDE, y, drawing.LINE)]
    for metre in range(0, 11, 2):
        x, y = _pixels((metre, metre))
        parts.append(drawing.text(x, TOP + SIDE + 16, f"{metre}", 11))
        parts.append(drawing.text(LEFT - 7, y + 4, f"{metre}", 11, "end"))
    parts.append(drawing.text(LEFT + SIDE / 2, TOP + SIDE + 32, "x in metres", 11))
    across = f'transform="translate(12 {number(TOP + SIDE / 2, 1)}) rotate(-90)"'
    parts.append(f"<g {across}>{drawing.text(0, 0, 'y in metres', 11)}</g>")
    frame = f'{drawing.sizes(width=SIDE, height=SIDE)} fill="none" stroke="{drawing.INK}" stroke-width="1.5"'
    return [*parts, f'<rect x="{LEFT:g}" y="{TOP:g}" {frame}/>']


def _line(x: float, y: float, to_x: float, to_y: float, colour: str, more: str = "") -> str:
    return f'<line {drawing.sizes(x1=x, y1=y, x2=to_x, y2=to_y)} stroke="{colour}" {more}/>'


def _disc(x: float, y: float, radius: int, look: str) -> str:
    return f'<circle cx="{number(x, 1)}" cy="{number(y, 1)}" r="{radius}" {look}/>'


def _flag(x: float, y: float, scale: float) -> str:
    """A flag, and the ring within which the goal counts as reached; `scale` is pixels a metre."""
    corners = ((0.0, 0.87), (0.44, 0.71), (0.0, 0.55))
    points = " ".join(f"{number(right * scale, 1)},{number(-up * scale, 1)}" for right, up in corners)
    ring = f'<circle r="{number(TOLERANCE * scale, 1)}" fill="none" stroke="{drawing.VERMILLION}" stroke-width="1.5"/>'
    pole = _line(0, 0, 0, -0.87 * scale, drawing.INK, 'stroke-width="1.5"')
    place = f"translate({number(x, 1)} {number(y, 1)})"
    return f'<g transform="{place}">{ring}{pole}<polygon points="{points}" fill="{drawing.VERMILLION}"/></g>'
