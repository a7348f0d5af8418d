"""The goal pad: the map with the turtle's trail, the clock, the goals, and an editor of obstacles."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import asdict, replace
from itertools import product
from typing import Any, ClassVar

import numpy as np
import traitlets

from ...turtlesim.obstacles import WORLDS, Box, Circle, Obstacle
from ..drawing import Picture
from ..path import Trail, plot_path
from ..words import angle, count, listed, number, point, within
from .backend import Link, let_time_go_on
from .goal_client import Goal, GoalClient
from .live_widget import LiveWidget, pack

SPACING, KEPT, TAIL = 0.05, 600, 60
"""Metres from one point of the trail to the next, how many points are kept (30 m of way), and how many may be new until the
whole trail is sent again."""

BREAK = np.full((1, 2), np.nan)
"""Where the trail breaks."""

STALE = 1.5
"""A scan older than this, s of robot time, is not drawn on the map; the panels of scan and status then say so."""

FASTEST = "max"
"""What the browser calls an infinite rate, which JSON does not know."""

SHOWN = 60
"""How many of the newest goals the browser is told of."""

ROOM = 0.8
"""A fresh obstacle leaves so much room around it where it can, m."""


class GoalPad(LiveWidget):
    """Shows the world as the topics tell of it, sends goals to the navigator, turns the clock and changes the obstacles.

    An order names an obstacle by its place in the list, from 0.
    """

    PANELS: ClassVar[tuple[str, ...]] = ("clock", "map", "goals", "editor")
    SCRIPTS = (
        *("dom", "clock", "map", "goals", "editor", "signs", "status", "log", "scan", "rates", "lights"),
        *("dashboard", "goal_pad", "lab_view"),
    )
    STYLES = ("base", "dashboard", "lab_view", "map", "clock", "goals", "editor")

    title = traitlets.Unicode("Goal pad").tag(sync=True)
    panels = traitlets.List(traitlets.Unicode()).tag(sync=True)
    pose = traitlets.Bytes().tag(sync=True)
    """x, y, theta, speed (m, rad, m/s); not-a-number where none was heard."""
    trail = traitlets.Bytes().tag(sync=True)
    """The turtle's way: x, y, x, y, …, m; it breaks at two not-a-numbers."""
    tail = traitlets.Bytes().tag(sync=True)
    """The newest part of its way, which follows on `trail`."""
    scan = traitlets.Bytes().tag(sync=True)
    """The newest scan: angle_min, angle_increment (rad), range_max (m), then the distances (m)."""
    scanned_from = traitlets.Bytes().tag(sync=True)
    """Where the turtle was at that scan: x, y, theta (m, rad); empty when that was too long ago."""
    obstacles = traitlets.List(traitlets.Dict()).tag(sync=True)
    """"shape" ("circle" or "box"), x, y, width, height (m), angle (rad) of each."""
    worlds = traitlets.List(traitlets.Unicode(), list(WORLDS)).tag(sync=True)
    """The names of the ready-made worlds."""
    now = traitlets.Float(0.0).tag(sync=True)
    """Robot time, s."""
    clock = traitlets.Dict().tag(sync=True)
    """Whether it can be turned ("turns"), whether it goes ("playing"), and at which "rate" it shall go ("max": as fast as
    possible)."""
    wall = traitlets.Dict().tag(sync=True)
    """The "seconds" of wall time since it was played, and the "speed" that it really reaches; 0 while it stands still."""
    goals = traitlets.List(traitlets.Dict()).tag(sync=True)
    """The newest goals, in the order in which they were sent; `Goal` says what there is of each."""

    def __init__(self, backend: Link, **traits: Any) -> None:
        self._trail = Trail(SPACING, TAIL, KEPT)
        self.desk = GoalClient(backend, self._goal_changed)
        self._goal_news = False
        super().__init__(backend, panels=list(self.PANELS), **traits)
        self.tick()

    def closed(self) -> None:
        """Stop listening, as soon as every goal has its answer."""
        if not any(goal.waits for goal in self.desk.goals):
            self.desk.close()

    def left(self) -> None:
        self.desk.close()

    def tick(self) -> None:
        self._show_map()
        self._show_clock()
        if self.due("navigator", 2):
            self.desk.look()
        if self._goal_news:
            self._goal_news = False
            self.goals = [asdict(each) for each in self.desk.goals[-SHOWN:]]

    def _text(self) -> str:
        here = f"{self.title} at {number(self.backend.now)} s of robot time: {self._place()}."
        return f"{here} {self._goals_in_words()} {self._obstacles_in_words()}"

    def _picture(self) -> Picture | None:
        goals = [(goal.x, goal.y, goal.theta) for goal in self.desk.goals if goal.state in ("on its way", "reached")]
        return plot_path(self.backend.recorder, goal=goals[-1:] or None)

    def _place(self) -> str:
        pose = self.backend.recorder.pose()
        return f"the turtle is at {point(*pose[:2])} m facing {angle(pose[2])}" if pose else "no pose heard yet"

    # -- map ---------------------------------------------------------------------------------------------------------

    def _show_map(self) -> None:
        recorder = self.backend.recorder
        pose = recorder.poses.last()
        if self.is_new("pose", pose):
            self.pose = pack(pose[1:] or [math.nan] * 4)
            # in the same frame as the pose, to which the browser joins it: that line never shows a way that was not driven
            if self._trail.follow(recorder.poses):
                if self.is_new("trail", self._trail.changes):
                    pieces = [np.concatenate([BREAK, piece]) for piece in self._trail.old]
                    self.trail = b"".join(map(pack, pieces))
                self.tail = pack(np.concatenate([BREAK, self._trail.tip[:-1]]))
        scanned = recorder.scans.last()
        if scanned and self.backend.now - recorder.seconds(scanned[0]) > STALE:
            self.scanned_from = b""
        elif (scan := recorder.last_scan) is not None and self.is_new("scan", scanned):
            self.scan = pack([scan.angle_min, scan.angle_increment, scan.range_max, *scan.ranges])
            self.scanned_from = pack(recorder.pose_at_scan() or [])
        if self.is_new("obstacles", self.backend.board.obstacles):
            told = ("shape", "x", "y", "width", "height", "angle")
            self.obstacles = [{name: getattr(each, name) for name in told} for each in self.backend.board.obstacles]

    # -- clock -------------------------------------------------------------------------------------------------------

    def _show_clock(self) -> None:
        self.now = round(self.backend.now, 3)
        clock = self.backend.clock
        if clock is None:
            self.clock = {"turns": False, "playing": True, "rate": 1.0}
            return
        rate = clock.rate if math.isfinite(clock.rate) else FASTEST
        state = {"turns": True, "playing": clock.playing, "rate": rate}
        changed = state != self.clock
        self.clock = state
        if self.due("wall", 5) or changed:
            self.wall = {"seconds": round(clock.wall_seconds, 1), "speed": float(f"{clock.speed:.2g}")}

    def do_play(self) -> None:
        """Let robot time go on."""
        if self.backend.clock is not None:
            self.backend.clock.play(self.backend.clock.rate)

    def do_rate(self, rate: float | str) -> None:
        """Say how fast it shall go on; "max" is as fast as possible."""
        if self.backend.clock is not None:
            self.backend.clock.rate = math.inf if rate == FASTEST else rate  # type: ignore[assignment]

    def do_pause(self) -> None:
        """Let robot time stand still."""
        if self.backend.clock is not None:
            self.backend.clock.pause()

    def do_step(self, seconds: float) -> None:
        """Let a little robot time pass."""
        lasts = within("step", seconds, 0, 1)
        if self.backend.clock is not None:
            self.backend.clock.step(lasts)

    # -- editor ------------------------------------------------------------------------------------------------------

    def do_obstacle_add(self, shape: str) -> None:
        """Put a fresh circle or box where there is room."""
        x, y = self._free_place()
        fresh: Obstacle = Box(x, y, width=1.5, height=0.5) if shape == "box" else Circle(x, y, radius=0.5)
        self._put([*self.backend.board.obstacles, fresh], f"Added a {fresh}.")

    def do_obstacle_change(self, number: int, done: bool = True, **fields: float) -> None:
        """Change some fields of one; `done` is False while it is being dragged."""
        obstacles = list(self.backend.board.obstacles)
        obstacles[number] = replace(self._obstacle(number), **fields)  # type: ignore[arg-type]
        self._put(obstacles, f"Now a {obstacles[number]}." if done else "")

    def do_obstacle_move(self, number: int, right: float, up: float) -> None:
        """Move one by so many metres; of keys pressed fast none is lost, since it counts from where it is now."""
        old = self._obstacle(number)
        self.do_obstacle_change(number, x=round(old.x + right, 6), y=round(old.y + up, 6))

    def do_obstacle_remove(self, number: int) -> None:
        """Take one away."""
        gone = self._obstacle(number)
        left = [each for place, each in enumerate(self.backend.board.obstacles) if place != number]
        self._put(left, f"Removed the {gone}.")

    def do_world(self, name: str) -> None:
        """Replace all obstacles by those of a ready-made world."""
        self._put(str(name), f"Loaded the world “{name}”.")

    def _obstacles_in_words(self) -> str:
        """How many obstacles there are."""
        return f"{count(len(self.backend.board.obstacles), 'obstacle').capitalize()} in the world."

    def _obstacle(self, number: int) -> Obstacle:
        obstacles = self.backend.board.obstacles
        if not isinstance(number, int) or not 0 <= number < len(obstacles):
            raise ValueError("That obstacle is gone.")
        return obstacles[number]

    def _put(self, obstacles: list[Obstacle] | str, words: str) -> None:
        self.backend.board.put(obstacles)
        if words:
            clock = self.backend.clock
            later = clock is not None and not clock.playing
            hint = " The nodes notice it once robot time passes." if later else ""
            self.words = f"{words} {self._obstacles_in_words()}{hint}"

    def _free_place(self) -> tuple[float, float]:
        """A place away from the turtle and the obstacles, as near to the middle as can be."""
        taken = [(each.x, each.y, math.hypot(each.width, each.height) / 2) for each in self.backend.board.obstacles]
        if pose := self.backend.recorder.pose():
            taken.append((*pose[:2], ROOM))
        steps = [0.5 + 0.5 * step for step in range(21)]
        middle = (5.5, 5.5)
        places = sorted(product(steps, steps), key=lambda place: math.dist(place, middle))
        free = (place for place in places if all(math.dist(place, (x, y)) > reach + ROOM for x, y, reach in taken))
        return next(free, middle)

    # -- goals -------------------------------------------------------------------------------------------------------

    def do_goal(self, x: float, y: float, theta: float) -> None:
        """Send a goal, and let time go on if it stands still."""
        if self.desk.send(x, y, theta).waits:
            let_time_go_on(self.backend)

    def _goals_in_words(self) -> str:
        """How many goals were sent, what became of them, and what of the last one."""
        goals = self.desk.goals
        if not goals:
            return "No goal sent yet."
        states = Counter(goal.state for goal in goals)
        last = goals[-1]
        place = f"Goal {last.number} at {point(last.x, last.y)} m facing {angle(last.theta)}"
        counted = listed([f"{amount} {state}" for state, amount in states.items()])
        return f"{count(len(goals), 'goal').capitalize()} sent: {counted}. {place}: {_ending(last)}"

    def _goal_changed(self, goal: Goal) -> None:
        self._goal_news = True
        self.words = f"Goal {goal.number} at {point(goal.x, goal.y)} m: {_ending(goal)}"
        if not self._is_open:
            self.closed()


def _ending(goal: Goal) -> str:
    return f"{goal.state}. {goal.answer}" if goal.answer else f"{goal.state}."
