"""What need not be brought up to date at every tick: histories, rates and lists are looked at more rarely."""

from __future__ import annotations

from ...ros.core.virtual_time import real_monotonic


class Pace:
    """Says when something is due again, so many times a second of real time at most."""

    def __init__(self, hertz: float) -> None:
        self._period = 1 / hertz
        self._next = -1.0

    def due(self) -> bool:
        """Whether it is time again; if so, the next time is a period from now."""
        now = real_monotonic()
        if now < self._next:
            return False
        self._next = now + self._period
        return True
