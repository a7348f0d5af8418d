"""The dashboard: everything about a running system at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..beams import read_beams
from ..words import angle, count, listed, number, point
from .lab_view import LabView
from .panel_lights import LightsPanel, look, missing
from .panel_log import LogPanel
from .panel_rates import RatesPanel
from .panel_scan import ScanPanel, in_words
from .panel_status import StatusPanel

if TYPE_CHECKING:
    from ..picture import Picture
    from .station import Station

DASHBOARD = ["clock", "map", "goals", "editor", "status", "log", "scan", "rates", "lights"]


class Dashboard(LogPanel, LightsPanel, RatesPanel, ScanPanel, StatusPanel, LabView):
    """The goal pad, and beside it status, scan, topics, nodes, services and log."""

    def __init__(self, station: Station) -> None:
        super().__init__(station, DASHBOARD)
        self.title = "Dashboard"

    def text(self) -> str:
        """Time, place, battery, the nearest thing, what is missing, and how many goals were sent."""
        facts = [self._place(), *self._nearest(), self._presence(), f"{count(len(self.desk.goals), 'goal')} sent"]
        return f"Dashboard at {number(self.station.now)} s of robot time: {'; '.join(facts)}."

    def picture(self) -> Picture | None:
        """Path and status side by side."""
        from .dashboard_picture import dashboard_picture

        kept = [goal for goal in self.desk.goals if goal.was_taken]
        return dashboard_picture(self.station.recorder, self.text(), kept[-1] if kept else None)

    def _place(self) -> str:
        recorder = self.station.recorder
        poses, statuses = recorder.poses.newest(1), recorder.statuses.newest(1)
        if not len(poses):
            return "no pose heard yet"
        x, y, theta = (poses[0][name] for name in ("x", "y", "theta"))
        battery = f", battery {number(statuses[0]['battery'], 1)} %" if len(statuses) else ""
        return f"the turtle is at {point(x, y)} m facing {angle(theta)}{battery}"

    def _nearest(self) -> list[str]:
        scan = self.station.recorder.last_scan
        if scan is None:
            return ["no scan heard yet"]
        words = in_words(read_beams(scan))
        return [f"nearest in the scan: {words['nearest']}"]

    def _presence(self) -> str:
        lost = missing(look(self.station.node))
        return f"missing: {listed(lost)}" if lost else "all expected nodes and services are there"
