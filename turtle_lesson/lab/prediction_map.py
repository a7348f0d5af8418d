"""The map of a prediction: where the turtle stood, its goal, where the reader guessed that it ends, and where it ended."""

from __future__ import annotations

from . import drawing as svg
from . import style
from .path import TOLERANCE, WORLD, Goal
from .words import number, point

SCALE = 24.0
"""Pixels a metre."""
LEFT, TOP, RIGHT, BOTTOM = 40.0, 14.0, 18.0, 42.0
"""Pixels around the world: a mark at a wall is not cut."""
KEY = 22.0
"""Pixels a line of the key."""

Place = tuple[float, float]


def draw_map(turtle: tuple[float, float, float] | None, goal: Goal | None, guess: Place | None, outcome: Place) -> str:
    """Return the map as an element of HTML; its alternative text says what is where."""
    side = WORLD * SCALE
    signs: list[tuple[str, str, str]] = []  # on the map, in the key, and in words
    if turtle is not None:
        signs.append(
            (svg.turtle(*_pixels(turtle[:2]), turtle[2], SCALE), svg.turtle(0, 0, 0, 18), _words("start", turtle))
        )
    if goal is not None:
        signs.append((_flag(*_pixels(goal), SCALE), _flag(-2, 6, 16), _words("goal", goal)))
    if guess is not None:
        signs.append((_ring(*_pixels(guess)), _ring(0, 0), _words("your guess", guess)))
    signs.append((_disc(*_pixels(outcome)), _disc(0, 0), _words("outcome", outcome)))
    parts = _axes(side)
    if guess is not None:
        parts.append(_line(*_pixels(guess), *_pixels(outcome), style.INK, 'stroke-dasharray="4 4"'))
    parts += [on_map for on_map, _, _ in signs]
    top = TOP + side + BOTTOM
    for row, (_, sign, words) in enumerate(signs):
        y = top + KEY * (row + 0.5)
        parts.append(f'<g transform="translate({LEFT + 10:g} {number(y, 1)})">{sign}</g>')
        parts.append(svg.text(LEFT + 28, y + 4, words, 13, "start"))
    description = f"Map of the turtle's world: {'; '.join(words for _, _, words in signs)}."
    drawing = svg.document(
        round(LEFT + side + RIGHT), round(top + KEY * len(signs) + 4), "Guess and outcome", description, parts
    )
    return svg.image(drawing, description)


def _words(name: str, place: tuple[float, ...] | Goal) -> str:
    return f"{name} {point(place[0], place[1])} m"


def _pixels(place: tuple[float, ...] | Goal) -> Place:
    """A place on the drawing; one beyond the walls is shown at the wall."""
    x, y = (max(0.0, min(WORLD, float(each or 0.0))) for each in place[:2])
    return LEFT + x * SCALE, TOP + (WORLD - y) * SCALE


def _axes(side: float) -> list[str]:
    """The walls, a line at each metre, and figures at every second one."""
    parts = []
    for metre in range(1, int(WORLD) + 1):
        x, y = _pixels((metre, metre))
        parts += [_line(x, TOP, x, TOP + side, style.LINE), _line(LEFT, y, LEFT + side, y, style.LINE)]
    for metre in range(0, 11, 2):
        x, y = _pixels((metre, metre))
        parts += [svg.text(x, TOP + side + 16, f"{metre}", 11), svg.text(LEFT - 7, y + 4, f"{metre}", 11, "end")]
    parts.append(svg.text(LEFT + side / 2, TOP + side + 32, "x in metres", 11))
    across = f'transform="translate(12 {number(TOP + side / 2, 1)}) rotate(-90)"'
    parts.append(f"<g {across}>{svg.text(0, 0, 'y in metres', 11)}</g>")
    size = number(side, 1)
    frame = f'fill="none" stroke="{style.INK}" stroke-width="1.5"'
    parts.append(f'<rect x="{LEFT:g}" y="{TOP:g}" width="{size}" height="{size}" {frame}/>')
    return parts


def _line(x: float, y: float, to_x: float, to_y: float, colour: str, more: str = "") -> str:
    ends = " ".join(
        f'{name}="{number(at, 1)}"' for name, at in zip(("x1", "y1", "x2", "y2"), (x, y, to_x, to_y), strict=True)
    )
    return f'<line {ends} stroke="{colour}" {more}/>'


def _ring(x: float, y: float) -> str:
    place = f'cx="{number(x, 1)}" cy="{number(y, 1)}"'
    return f'<circle {place} r="8" fill="none" stroke="{style.BLUE}" stroke-width="3"/>'


def _disc(x: float, y: float) -> str:
    return f'<circle cx="{number(x, 1)}" cy="{number(y, 1)}" r="6" fill="{style.PURPLE}"/>'


def _flag(x: float, y: float, scale: float) -> str:
    """A flag, and the ring within which the goal counts as reached; `scale` is pixels a metre."""
    corners = " ".join(
        f"{number(right * scale, 1)},{number(-up * scale, 1)}" for right, up in ((0, 0.87), (0.44, 0.71), (0, 0.55))
    )
    ring = f'<circle r="{number(TOLERANCE * scale, 1)}" fill="none" stroke="{style.VERMILLION}" stroke-width="1.5"/>'
    pole = _line(0, 0, 0, -0.87 * scale, style.INK, 'stroke-width="1.5"')
    place = f"translate({number(x, 1)} {number(y, 1)})"
    return f'<g transform="{place}">{ring}{pole}<polygon points="{corners}" fill="{style.VERMILLION}"/></g>'
