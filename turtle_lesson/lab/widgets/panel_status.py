"""The panel with the status: position, heading, speed and battery over the last seconds."""

from __future__ import annotations

from typing import Any

import numpy as np
import traitlets

from ..recording import NANOSECONDS, STATUS_TOPIC
from .live_widget import LiveWidget
from .pace import Pace
from .packing import pack
from .silence import why_silent

WINDOW = 30.0
"""Seconds of robot time that the curves show."""
MOST = 3000
"""Statuses that are looked at: those of the window at a hundred a second."""
POINTS = 300
"""About so many of them are drawn at most: one every 0.1 s."""
LATE = 1.5
"""Seconds without a status after which the panel says so."""


class StatusPanel(LiveWidget):
    """Shows what came on /robot/status."""

    status = traitlets.Bytes().tag(sync=True)
    """A row for each status: its age (s), x, y (m), heading (rad), speed (m/s), battery (%)."""
    status_note = traitlets.Unicode().tag(sync=True)
    """Why there is no status, if there is none."""

    def __init__(self, *arguments: Any, **traits: Any) -> None:
        self._status_pace, self._status_note_pace = Pace(10), Pace(1)
        self._status_seen: tuple[float, int] | None = None
        super().__init__(*arguments, **traits)

    def tick(self) -> None:
        """Read the newest statuses."""
        super().tick()
        if not self._status_pace.due():
            return
        recorder, now = self.station.recorder, self.station.now
        newest = recorder.statuses.newest(1)
        stamp = int(newest["stamp"][0]) if len(newest) else 0
        if self._status_seen != (now, stamp):
            self._status_seen = (now, stamp)
            self.status = pack(_window(recorder.statuses.newest(MOST), recorder.origin + round(now * NANOSECONDS)))
        if len(newest):
            age = now - float(recorder.seconds(stamp))
            self.status_note = f"No status for {age:.0f} s." if age > LATE else ""
        elif self._status_note_pace.due():
            self.status_note = why_silent(self.station, STATUS_TOPIC)


def _window(rows: np.ndarray, now: int) -> np.ndarray:
    """The rows of the window, thinned so that a point that stays does not move while time goes on."""
    ages = (now - rows["stamp"]) / NANOSECONDS
    rows, ages = rows[ages <= WINDOW], ages[ages <= WINDOW]
    if len(rows) > POINTS:
        slots = rows["stamp"] // round(WINDOW / POINTS * NANOSECONDS)
        kept = np.append(slots[1:] != slots[:-1], True)
        rows, ages = rows[kept], ages[kept]
    speed = np.hypot(rows["vel_x"], rows["vel_y"])
    return np.column_stack([ages, rows["x"], rows["y"], rows["theta"], speed, rows["battery"]])
