"""Small drawings as SVG, written here letter by letter: the same on every machine, and legible on light and dark.

They need neither a kernel nor a network, so they are also seen in static HTML and on GitHub.
"""

from __future__ import annotations

import base64
import html
import math

from . import style
from .drawing import BACK, BODY, EYES, HEAD, LEGS, OUTLINE, RIM, SHELL, SKIN, TAIL
from .words import number

FONT = "system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif"
NARROW, WIDE = "ijltfrI.,:;|!'()[]/ ", "mwMW@%"


def text_width(text: str, size: float) -> float:
    """About how many pixels a text of this size is wide, a little more rather than less."""
    return size * sum(0.36 if each in NARROW else 0.92 if each in WIDE else 0.61 for each in text)


def text(x: float, y: float, words: str, size: float = 12, anchor: str = "middle", fill: str = style.INK) -> str:
    """Words whose baseline is at `y`, and whose middle (or "start" or "end") is at `x`."""
    look = f'font-size="{size:g}" text-anchor="{anchor}" fill="{fill}"'
    return f'<text x="{number(x, 1)}" y="{number(y, 1)}" {look}>{html.escape(words)}</text>'


def document(width: float, height: float, title: str, description: str, parts: list[str]) -> str:
    """Return a whole drawing; its title and description are read out where it cannot be seen."""
    size = f'width="{width:g}" height="{height:g}" viewBox="0 0 {width:g} {height:g}"'
    head = f"<title>{html.escape(title)}</title><desc>{html.escape(description)}</desc>"
    body = "\n".join(parts)
    frame = f'<svg xmlns="http://www.w3.org/2000/svg" role="img" {size} style="max-width: 100%" font-family="{FONT}">'
    return f"{frame}\n{head}\n{body}\n</svg>"


def image(drawing: str, alternative: str) -> str:
    """Return a drawing as an element of HTML with its alternative text; Jupyter's filter lets it pass."""
    data = base64.b64encode(drawing.encode()).decode()
    return f'<img alt="{html.escape(alternative)}" src="data:image/svg+xml;base64,{data}">'


def turtle(x: float, y: float, theta: float, length: float) -> str:
    """The turtle from above: its middle at (x, y) pixels, looking along `theta` (radians, to the left)."""

    def oval(shape: tuple[float, ...], fill: str, side: int = 1) -> str:
        across, up, width, height, turn = shape
        place = f"translate({across:g} {side * up:g}) rotate({side * turn:g})"
        return f'<ellipse rx="{width / 2:g}" ry="{height / 2:g}" transform="{place}" fill="{fill}"/>'

    tail = " ".join(f"{a:g},{b:g}" for a, b in TAIL)
    parts = [f'<polygon points="{tail}" fill="{SKIN}"/>']
    parts += [oval(leg, SKIN, side) for leg in LEGS for side in (1, -1)]
    parts.append(oval(HEAD, SKIN))
    parts += [
        f'<circle cx="{EYES[0]:g}" cy="{side * EYES[1]:g}" r="{EYES[2]:g}" fill="{OUTLINE}" stroke="none"/>'
        for side in (1, -1)
    ]
    parts += [oval(BODY, RIM), oval(BACK, SHELL)]
    place = f"translate({number(x, 1)} {number(y, 1)}) rotate({number(-math.degrees(theta), 1)}) scale({length:g})"
    return f'<g transform="{place}" stroke="{OUTLINE}" stroke-width="0.015">{"".join(parts)}</g>'
