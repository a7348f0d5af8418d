"""Service calls as a drawing: a line downwards for each program, an arrow for each message, a note for each callback."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from . import style, svg
from .call_steps import Step
from .graph_drawing import LOOKS
from .sequence_text import Event, events_of, programs_of
from .words import number

SIZE, LINE = 12.0, 15.0
"""Pixels of a text, and from line to line."""
APART, EDGE, TOP = 290.0, 120.0, 44.0
"""Pixels between two programs, beside the outer ones, and above the first event."""
LONGEST = 38
"""Characters of a line."""


def draw_sequence(steps: Sequence[Step], title: str, description: str) -> str:
    """Return the drawing of these calls as SVG; its title and description are for readers who cannot see it."""
    programs = programs_of(steps)
    places = {name: EDGE + APART * at for at, name in enumerate(programs)}
    busy: dict[str, list[float]] = {}
    parts, bars, y = [], [], TOP
    for event in events_of(steps):
        x = places[event.of]
        if event.kind == "activate":
            busy.setdefault(event.of, []).append(y)
        elif event.kind == "deactivate":
            bars.append(_bar(x, busy[event.of].pop(), y))
        else:
            lines = [line for part in event.text.split("<br/>") for line in textwrap.wrap(part, LONGEST)]
            y += LINE * len(lines) + 14
            parts.append(_draw(event, x, places.get(event.to, x), y, lines))
            y += 6
    y += 12
    columns = [
        f'<path d="M{x:g},30V{number(y, 1)}" stroke="{style.EDGE}" stroke-width="1.2"/>' for x in places.values()
    ]
    heads = [_box(x, 6, svg.text_width(name, 12.5) + 24, 24, [name], "nodes") for name, x in places.items()]
    width = 2 * EDGE + APART * (len(programs) - 1)
    return svg.document(round(width), round(y + 4), title, description, [*columns, *bars, *parts, *heads])


def _draw(event: Event, x: float, to: float, y: float, lines: list[str]) -> str:
    """One event; `y` is where its arrow is, or where its note ends."""
    if event.kind == "note":
        width = max(svg.text_width(line, SIZE) for line in lines) + 16
        top = y - LINE * len(lines) - 4
        return _box(x, top, width, LINE * len(lines) + 8, lines, "services")
    if event.kind == "lost":
        end = x + APART / 2
        cross = f"M{end - 5:g},{number(y - 5, 1)}l10,10m0,-10l-10,10"
        arrow = f'<path d="M{x:g},{number(y, 1)}H{end:g}{cross}" stroke="{style.VERMILLION}" stroke-width="1.6" fill="none"/>'
    else:
        end = to
        side = 1 if to > x else -1
        dash = ' stroke-dasharray="5 4"' if event.kind == "answer" else ""
        stop = to - 12 * side
        head = f"M{to - 4 * side:g},{number(y, 1)}l{-9 * side},-4.5v9Z"
        arrow = (
            f'<path d="M{x + 4 * side:g},{number(y, 1)}H{stop:g}" stroke="{style.INK}" stroke-width="1.5"{dash}/>'
            f'<path d="{head}" fill="{style.INK}"/>'
        )
    first = y - 6 - LINE * (len(lines) - 1)
    return arrow + "".join(svg.text((x + end) / 2, first + LINE * at, line, SIZE) for at, line in enumerate(lines))


def _bar(x: float, begin: float, end: float) -> str:
    """While a callback runs, or waits."""
    size = f'y="{number(begin, 1)}" width="8" height="{number(end - begin, 1)}"'
    return f'<rect x="{x - 4:g}" {size} fill="{style.GREEN}" opacity="0.7"/>'


def _box(x: float, top: float, width: float, height: float, lines: list[str], kind: str) -> str:
    """Lines of text in a box that looks like those of this kind in the graph, with the same dark text in both kinds."""
    fill, edge, _ = LOOKS[kind]
    ink = LOOKS["nodes"][2]
    frame = (
        f'x="{number(x - width / 2, 1)}" y="{number(top, 1)}" width="{number(width, 1)}" height="{number(height, 1)}"'
    )
    first = top + height / 2 + 4.5 - LINE * (len(lines) - 1) / 2
    written = "".join(svg.text(x, first + LINE * at, line, SIZE, fill=ink) for at, line in enumerate(lines))
    return f'<rect {frame} rx="4" fill="{fill}" stroke="{edge}"/>{written}'
