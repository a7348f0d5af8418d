"""The panel that edits the world: add, move, change and remove obstacles, or load a ready-made world."""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import traitlets

from ...turtlesim.obstacles import WORLDS, Box, Circle
from ..obstacle_board import Obstacle
from ..words import count
from .live_widget import LiveWidget

CIRCLE, BOX = {"radius": 0.5}, {"width": 1.5, "height": 0.5}
"""The sizes of a fresh obstacle, m."""

ROOM = 0.8
"""A fresh obstacle leaves so much room around it where it can, m."""

MIDDLE = 5.5


class EditorPanel(LiveWidget):
    """Changes the obstacles. An order names an obstacle by its place in the list, from 0."""

    worlds = traitlets.List(traitlets.Unicode(), list(WORLDS)).tag(sync=True)
    """The names of the ready-made worlds."""

    def do_obstacle_add(self, shape: str) -> None:
        """Put a fresh circle or box where there is room."""
        x, y = self._free_place()
        fresh: Obstacle = Box(x, y, **BOX) if shape == "box" else Circle(x, y, **CIRCLE)
        self._put([*self.station.board.obstacles, fresh], f"Added a {fresh}.")

    def do_obstacle_change(self, number: int, done: bool = True, **fields: float) -> None:
        """Change some fields of one; `done` is False while it is being dragged."""
        obstacles = list(self.station.board.obstacles)
        old = self._obstacle(number)
        known = {name: getattr(old, name) for name in old.__slots__}
        unknown = sorted(set(fields) - set(known))
        if unknown:
            raise ValueError(f"A {type(old).__name__.lower()} has no {unknown[0]}; it has {', '.join(known)}.")
        obstacles[number] = type(old)(**{**known, **fields})
        self._put(obstacles, f"Now a {obstacles[number]}." if done else "")

    def do_obstacle_move(self, number: int, right: float, up: float) -> None:
        """Move one by so many metres; of keys pressed fast none is lost, since it counts from where it is now."""
        old = self._obstacle(number)
        self.do_obstacle_change(number, x=round(old.x + right, 6), y=round(old.y + up, 6))

    def do_obstacle_remove(self, number: int) -> None:
        """Take one away."""
        gone = self._obstacle(number)
        left = [each for place, each in enumerate(self.station.board.obstacles) if place != number]
        self._put(left, f"Removed the {gone}.")

    def do_world(self, name: str) -> None:
        """Replace all obstacles by those of a ready-made world."""
        self._put(str(name), f"Loaded the world “{name}”.")

    def obstacles_in_words(self) -> str:
        """How many obstacles there are."""
        return f"{count(len(self.station.board.obstacles), 'obstacle').capitalize()} in the world."

    def _obstacle(self, number: int) -> Obstacle:
        obstacles = self.station.board.obstacles
        if not isinstance(number, int) or not 0 <= number < len(obstacles):
            raise ValueError("That obstacle is gone.")
        return obstacles[number]

    def _put(self, obstacles: list[Obstacle] | str, words: str) -> None:
        self.station.board.put(obstacles)
        if words:
            clock = self.station.clock
            later = clock is not None and not clock.playing
            hint = " The nodes notice it once robot time passes." if later else ""
            self.words = f"{words} {self.obstacles_in_words()}{hint}"

    def _free_place(self) -> tuple[float, float]:
        """A place away from the turtle and the obstacles, as near to the middle as can be."""
        taken = [(each.x, each.y, _reach(each)) for each in self.station.board.obstacles]
        taken += [(float(x), float(y), ROOM) for _, x, y, *_ in self.station.recorder.poses.newest(1)]
        steps = [0.5 + 0.5 * step for step in range(21)]
        places = sorted(product(steps, steps), key=lambda place: math.dist(place, (MIDDLE, MIDDLE)))
        for place in places:
            if all(math.dist(place, (x, y)) > reach + ROOM for x, y, reach in taken):
                return place
        return MIDDLE, MIDDLE


def _reach(obstacle: Any) -> float:
    """How far an obstacle reaches from its middle at most, m."""
    return obstacle.radius if isinstance(obstacle, Circle) else math.hypot(obstacle.width, obstacle.height) / 2
