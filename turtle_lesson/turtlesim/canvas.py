"""What the turtles' pens have drawn, as coarse cells, for the colour sensor.

The real turtlesim draws into a picture of 500 by 500 pixels, 45 to the metre, and its colour sensor reads the
pixel under the turtle. Two facts of that picture (``turtle_frame.cpp`` of Humble) are kept here:

- it lies on top of the background and starts out transparent *white*, so that where nothing was drawn the
  sensor says (255, 255, 255), whatever the parameters ``background_r``, ``background_g`` and ``background_b``
  are;
- a turtle sees the trail that it draws itself, from the second tick of a drive on.

The picture itself is not kept: a square cell as wide as a standard pen (3 pixels) remembers the last colour
drawn through its middle. So a wide pen leaves no broader trail for the sensor than a narrow one, and the edge
of a trail is off by at most a pen's width. That costs one dictionary look-up a tick.
"""

from typing import TypeAlias

Colour: TypeAlias = tuple[int, int, int]
"""Red, green and blue, each from 0 to 255."""

BARE: Colour = (255, 255, 255)
"""What the sensor says where nothing was drawn."""

DEFAULT_PEN: Colour = (179, 184, 255)

PIXELS_PER_METRE = 45.0
CELL = 3 / PIXELS_PER_METRE
"""Side of a cell in metres."""

_SIDE = 500 / PIXELS_PER_METRE
_CELLS_PER_METRE = 1 / CELL
_ROW = 1024  # more than the cells in a row, so that a cell is one integer


def cell_at(x: float, y: float) -> int:
    """Return the number of the cell that holds the point (x, y), in metres."""
    return int(x * _CELLS_PER_METRE) * _ROW + int(y * _CELLS_PER_METRE)


class Canvas:
    """The cells that were drawn on, each with its last colour."""

    def __init__(self) -> None:
        self.cells: dict[int, Colour] = {}

    def colour_at(self, x: float, y: float) -> Colour:
        """Return the colour at the point (x, y), in metres."""
        return self.cells.get(cell_at(x, y), BARE)

    def draw(self, start: tuple[float, float], end: tuple[float, float], colour: Colour) -> None:
        """Draw a straight line between two points, (x, y) in metres, as far as it lies in the picture."""
        (x0, y0), (x1, y1) = start, end
        dx, dy = x1 - x0, y1 - y0
        begin, finish = _part_within(x0, dx, *_part_within(y0, dy, 0.0, 1.0))
        if begin > finish:
            return
        # Two samples a cell leave no gap.
        steps = int(max(abs(dx), abs(dy)) * (finish - begin) * _CELLS_PER_METRE * 2) + 1
        for step in range(steps + 1):
            part = begin + (finish - begin) * step / steps
            self.cells[cell_at(x0 + dx * part, y0 + dy * part)] = colour

    def clear(self) -> None:
        """Wipe everything that was drawn."""
        self.cells.clear()


def _part_within(start: float, way: float, begin: float, finish: float) -> tuple[float, float]:
    """Cut the part [begin, finish] of a way down to where start + part * way lies in the picture."""
    if way == 0.0:
        return (begin, finish) if 0.0 <= start <= _SIDE else (1.0, 0.0)
    first, last = sorted((-start / way, (_SIDE - start) / way))
    return max(begin, first), min(finish, last)
