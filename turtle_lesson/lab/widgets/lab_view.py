"""The goal pad and the dashboard: one widget, with few panels or with many."""

from __future__ import annotations

from typing import TYPE_CHECKING

import traitlets

from ..path import plot_path
from ..words import angle, count, point
from .live_widget import script, styles
from .panel_clock import ClockPanel
from .panel_goals import GoalsPanel
from .panel_map import MapPanel

if TYPE_CHECKING:
    from ..picture import Picture
    from .station import Station


GOAL_PAD = ["clock", "map", "goals"]
SCRIPTS = ("clock", "map", "goals", "signs", "status", "log", "scan", "rates", "lights", "dashboard", "lab_view")


class LabView(GoalsPanel, MapPanel, ClockPanel):
    """Panels on one running system, all drawn from the same state.

    Each kind of panel is a class of its own, with its traits, its `tick` and its orders, and a file of its own in `js`.
    """

    panels = traitlets.List(traitlets.Unicode()).tag(sync=True)

    def __init__(self, station: Station, panels: list[str]) -> None:
        self._esm = script("dom", *SCRIPTS)
        self._css = styles("base", "lab_view")
        super().__init__(station, panels=panels)
        self.tick()

    def text(self) -> str:
        """Where the turtle is, and what became of the last goal."""
        poses = self.station.recorder.poses.array()
        if not len(poses):
            return "Goal pad: no pose heard yet."
        x, y, theta = (poses[-1][name] for name in ("x", "y", "theta"))
        sent = count(len(self.desk.goals), "goal")
        return f"Goal pad: the turtle is at {point(x, y)} m facing {angle(theta)}; {sent} sent."

    def picture(self) -> Picture | None:
        """The map with the path so far."""
        return plot_path(self.station.recorder)
