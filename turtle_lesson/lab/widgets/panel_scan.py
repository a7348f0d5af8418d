"""The panel with the scan: what the laser sees around the turtle, and how near the nearest thing is."""

from __future__ import annotations

import math
from typing import Any

import traitlets

from ..beams import Beams, read_beams
from ..recording import SCAN_TOPIC
from ..words import number
from .live_widget import LiveWidget
from .pace import Pace
from .silence import why_silent

LATE = 1.5
"""Seconds without a scan after which the panel says so."""


class ScanPanel(LiveWidget):
    """Says what the newest scan means; the scan itself is a trait of the map, whose points it also makes."""

    scan_words = traitlets.Dict().tag(sync=True)
    """"nearest" and "count" in words, the index of the nearest "beam" (-1: none), and a "note" on silence."""

    def __init__(self, *arguments: Any, **traits: Any) -> None:
        self._scan_pace, self._scan_note_pace = Pace(10), Pace(1)
        self._scan_read: Any = None
        super().__init__(*arguments, **traits)

    def tick(self) -> None:
        """Read the newest scan."""
        super().tick()
        if not self._scan_pace.due():
            return
        recorder = self.station.recorder
        scan = recorder.last_scan
        if scan is None:
            if self._scan_note_pace.due():
                note = why_silent(self.station, SCAN_TOPIC)
                self.scan_words = {"beam": -1, "nearest": "", "count": "", "note": note}
            return
        age = self.station.now - float(recorder.seconds(recorder.scans.newest(1)["stamp"][0]))
        note = f"No scan for {age:.0f} s." if age > LATE else ""
        if scan is not self._scan_read:
            self._scan_read = scan
            self.scan_words = {**in_words(read_beams(scan)), "note": note}
        elif note != self.scan_words["note"]:
            self.scan_words = {**self.scan_words, "note": note}


def in_words(beams: Beams) -> dict[str, Any]:
    """The nearest thing and how many beams see anything: {"beam": …, "nearest": …, "count": …}."""
    beam = beams.nearest()
    counted = f"{int(beams.sees.sum())} of {len(beams)} beams see something"
    if beam is None:
        return {"beam": -1, "nearest": f"nothing within {number(beams.most, 1)} m", "count": counted}
    place = f"{number(beams.ranges[beam])} m, {direction(beams.angles[beam])}"
    return {"beam": beam, "nearest": place, "count": counted}


def direction(radians: float) -> str:
    """Where a beam looks: "ahead", "30° to the left", "behind"."""
    degrees = round(math.degrees(math.remainder(radians, math.tau)))
    if degrees == 0:
        return "straight ahead"
    if abs(degrees) == 180:
        return "straight behind"
    return f"{abs(degrees)}° to the {'left' if degrees > 0 else 'right'}"
