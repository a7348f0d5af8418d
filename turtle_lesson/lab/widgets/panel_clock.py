"""The panel with the clock: play, pause, step and rate; robot time beside wall time."""

from __future__ import annotations

import traitlets

from .live_widget import LiveWidget

LONGEST_STEP = 1.0
"""Seconds of robot time that one step may take."""


class ClockPanel(LiveWidget):
    """Shows the clock, and turns it where it can be turned."""

    now = traitlets.Float(0.0).tag(sync=True)
    """Robot time, s."""
    clock = traitlets.Dict().tag(sync=True)
    """Whether it can be turned ("turns"), whether it goes ("playing"), and its "rate"."""

    def tick(self) -> None:
        """Read the clock."""
        super().tick()
        clock = self.station.clock
        self.now = self.station.now
        playing, rate = (clock.playing, clock.rate) if clock is not None else (True, 1.0)
        self.clock = {"turns": clock is not None, "playing": playing, "rate": rate}

    def do_play(self, rate: float) -> None:
        """Let robot time go on."""
        if self.station.clock is not None:
            self.station.clock.play(rate)

    def do_pause(self) -> None:
        """Let robot time stand still."""
        if self.station.clock is not None:
            self.station.clock.pause()

    def do_step(self, seconds: float) -> None:
        """Let a little robot time pass."""
        if self.station.clock is not None:
            self.station.clock.step(min(float(seconds), LONGEST_STEP))
