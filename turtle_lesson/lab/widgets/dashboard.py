"""The dashboard, which shows everything about a running system at once, and the goal pad, which is a part of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import traitlets

from .. import style
from ..path import plot_path
from ..picture import SHARPNESS, Picture
from ..scan import read_beams
from ..status import plot_status
from ..words import angle, count, listed, number, point
from .live_widget import script, styles
from .panels_system import LightsPanel, LogPanel, RatesPanel, ScanPanel, StatusPanel, in_words, look, missing
from .panels_world import ClockPanel, EditorPanel, GoalsPanel, MapPanel

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .backend import Backend


def _side_by_side(cards: list[np.ndarray]) -> Figure:
    """A figure on which pictures (rows of pixels) stand side by side, pixel for pixel, their tops in line."""
    from matplotlib.figure import Figure

    gap = 12 * SHARPNESS
    width = sum(card.shape[1] + gap for card in cards) - gap
    height = max(len(card) for card in cards)
    figure = Figure(
        figsize=(width / style.DPI / SHARPNESS, height / style.DPI / SHARPNESS), dpi=style.DPI, facecolor="none"
    )
    left = 0
    for card in cards:
        figure.figimage(card, left, height - len(card), origin="upper")
        left += card.shape[1] + gap
    return figure


GOAL_PAD = ["clock", "map", "goals", "editor"]
SCRIPTS = ("clock", "map", "goals", "editor", "signs", "status", "log", "scan", "rates", "lights")
LAYOUTS = ("dashboard", "goal_pad", "lab_view")
STYLES = ("base", "dashboard", "lab_view", "map", "clock", "goals", "editor")


class LabView(GoalsPanel, EditorPanel, MapPanel, ClockPanel):
    """Panels on one running system, all drawn from the same state.

    Each kind of panel is a class of its own, with its traits, its `tick` and its orders, and a file of its own in `js`.
    """

    title = traitlets.Unicode("Goal pad").tag(sync=True)
    panels = traitlets.List(traitlets.Unicode()).tag(sync=True)

    def __init__(self, backend: Backend, panels: list[str]) -> None:
        self._esm = script("dom", *SCRIPTS, *LAYOUTS)
        self._css = styles(*STYLES)
        super().__init__(backend, panels=panels)
        self.tick()

    def text(self) -> str:
        """Where the turtle is, what became of the goals, and how many obstacles there are."""
        here = f"{self.title} at {number(self.backend.now)} s of robot time: {self._place()}."
        return f"{here} {self.goals_in_words()} {self.obstacles_in_words()}"

    def picture(self) -> Picture | None:
        """The map with the path so far."""
        goals = [(goal.x, goal.y, goal.theta) for goal in self.desk.goals if goal.state in ("on its way", "reached")]
        return plot_path(self.backend.recorder, goal=goals[-1:] or None)

    def _place(self) -> str:
        poses = self.backend.recorder.poses.newest(1)
        if not len(poses):
            return "no pose heard yet"
        x, y, theta = (poses[0][name] for name in ("x", "y", "theta"))
        return f"the turtle is at {point(x, y)} m facing {angle(theta)}"


DASHBOARD = ["clock", "map", "goals", "editor", "status", "log", "scan", "rates", "lights"]


class Dashboard(LogPanel, LightsPanel, RatesPanel, ScanPanel, StatusPanel, LabView):
    """The goal pad, and beside it status, scan, topics, nodes, services and log."""

    def __init__(self, backend: Backend) -> None:
        super().__init__(backend, DASHBOARD)
        self.title = "Dashboard"

    def text(self) -> str:
        """Time, place, battery, the nearest thing, what is missing, and how many goals were sent."""
        scan, lost = self.backend.recorder.last_scan, missing(look(self.backend.node))
        facts = [
            self._place(),
            "no scan heard yet" if scan is None else f"nearest in the scan: {in_words(read_beams(scan))['nearest']}",
            f"missing: {listed(lost)}" if lost else "all expected nodes and services are there",
            f"{count(len(self.desk.goals), 'goal')} sent",
        ]
        return f"Dashboard at {number(self.backend.now)} s of robot time: {'; '.join(facts)}."

    def picture(self) -> Picture | None:
        """Path, with the newest goal, and status side by side, as far as there is anything to draw."""
        kept = [(goal.x, goal.y, goal.theta) for goal in self.desk.goals if goal.was_taken]
        recorder = self.backend.recorder
        cards = [plot_path(recorder, goal=kept[-1] if kept else None), plot_status(recorder)]
        drawn = [card.pixels() for card in cards if card.figure is not None]
        return Picture(self.text(), _side_by_side(drawn) if drawn else None)

    def _place(self) -> str:
        recorder = self.backend.recorder
        statuses = recorder.statuses.newest(1)
        battery = f", battery {number(statuses[0]['battery'], 1)} %" if len(statuses) and len(recorder.poses) else ""
        return super()._place() + battery
