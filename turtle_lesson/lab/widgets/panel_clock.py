"""The panel with the clock: play, pause, step and rate; robot time beside wall time."""

from __future__ import annotations

import math

import traitlets

from .live_widget import LiveWidget
from .pace import Pace

LONGEST_STEP = 1.0
"""Seconds of robot time that one step may take."""

FASTEST = "max"
"""What the browser calls an infinite rate, which JSON does not know."""


class ClockPanel(LiveWidget):
    """Shows the clock, and turns it where it can be turned."""

    now = traitlets.Float(0.0).tag(sync=True)
    """Robot time, s."""
    clock = traitlets.Dict().tag(sync=True)
    """Whether it can be turned ("turns"), whether it goes ("playing"), and at which "rate" it shall go ("max": as fast as
    possible)."""
    wall = traitlets.Dict().tag(sync=True)
    """The "seconds" of wall time since it was played, and the "speed" that it really reaches; 0 while it stands still."""

    _wall_pace: Pace | None = None

    def tick(self) -> None:
        """Read the clock."""
        super().tick()
        self.now = round(self.station.now, 3)
        clock = self.station.clock
        if clock is None:
            self.clock = {"turns": False, "playing": True, "rate": 1.0}
            return
        rate = clock.rate if math.isfinite(clock.rate) else FASTEST
        state = {"turns": True, "playing": clock.playing, "rate": rate}
        self._wall_pace = self._wall_pace or Pace(5)
        if self._wall_pace.due() or state != self.clock:
            self.wall = {"seconds": round(clock.wall_seconds, 1), "speed": float(f"{clock.speed:.2g}")}
        self.clock = state

    def do_play(self) -> None:
        """Let robot time go on."""
        if self.station.clock is not None:
            self.station.clock.play(self.station.clock.rate)

    def do_rate(self, rate: float | str) -> None:
        """Say how fast it shall go on; "max" is as fast as possible."""
        if self.station.clock is not None:
            self.station.clock.rate = math.inf if rate == FASTEST else rate  # type: ignore[assignment]

    def do_pause(self) -> None:
        """Let robot time stand still."""
        if self.station.clock is not None:
            self.station.clock.pause()

    def do_step(self, seconds: float) -> None:
        """Let a little robot time pass."""
        if not isinstance(seconds, int | float) or not 0 < seconds <= LONGEST_STEP:
            raise ValueError(f"A step takes from 0 to {LONGEST_STEP} s of robot time, not {seconds!r}.")
        if self.station.clock is not None:
            self.station.clock.step(float(seconds))
