"""The goal pad, and what the dashboard has in common with it: panels on one running system."""

from __future__ import annotations

from typing import TYPE_CHECKING

import traitlets

from ..path import plot_path
from ..words import angle, number, point
from .live_widget import script, styles
from .panel_clock import ClockPanel
from .panel_editor import EditorPanel
from .panel_goals import GoalsPanel
from .panel_map import MapPanel

if TYPE_CHECKING:
    from ..picture import Picture
    from .station import Station


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

    def __init__(self, station: Station, panels: list[str]) -> None:
        self._esm = script("dom", *SCRIPTS, *LAYOUTS)
        self._css = styles(*STYLES)
        super().__init__(station, panels=panels)
        self.tick()

    def text(self) -> str:
        """Where the turtle is, what became of the goals, and how many obstacles there are."""
        sentences = [
            f"{self.title} at {number(self.station.now)} s of robot time: {self._place()}.",
            self.goals_in_words(),
            self.obstacles_in_words(),
        ]
        return " ".join(sentences)

    def picture(self) -> Picture | None:
        """The map with the path so far."""
        goals = [(goal.x, goal.y, goal.theta) for goal in self.desk.goals if goal.state in ("on its way", "reached")]
        return plot_path(self.station.recorder, goal=goals[-1:] or None)

    def _place(self) -> str:
        poses = self.station.recorder.poses.newest(1)
        if not len(poses):
            return "no pose heard yet"
        x, y, theta = (poses[0][name] for name in ("x", "y", "theta"))
        return f"the turtle is at {point(x, y)} m facing {angle(theta)}"
