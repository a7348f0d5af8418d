"""Data on its way to a widget: how often it is looked at, how it is packed, how often messages come, and why none do."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ...ros.stdlib.clocks import real_monotonic
from ..recording import NANOSECONDS
from .backend import Backend

# -- pace ---------------------------------------------------------------------------------------------------------
# What need not be brought up to date at every tick: histories, rates and lists are looked at more rarely.


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


# -- packing ------------------------------------------------------------------------------------------------------
# Numbers on their way to the browser: 32-bit floats, as bytes.


def pack(numbers: ArrayLike) -> bytes:
    """Numbers in their order as little-endian 32-bit floats; JavaScript reads them as a Float32Array."""
    return np.ascontiguousarray(numbers, dtype="<f4").tobytes()


# -- silence ------------------------------------------------------------------------------------------------------
# Why nothing was heard on a topic, for those who look at a widget and may have no cell to type in.


def why_silent(backend: Backend, topic: str) -> str:
    """A sentence on why nothing came on a topic that the recorder hears, and what to try."""
    if backend.node.count_publishers(topic):
        return f"No message has come on {topic} yet: messages come while robot time passes."
    return backend.recorder.why_silent(topic)


# -- frequency ----------------------------------------------------------------------------------------------------
# How often messages come, from the times at which they were sent, and whether that is as it should be.

WINDOW = 5.0
"""Seconds of robot time over which a rate is measured."""
PAUSE = 1.0
"""Seconds without a message after which a topic that should go on counts as silent."""
TOLERANCE = 0.15
"""By this share a rate may be off and still be as expected."""


def frequency(stamps: np.ndarray, now: int, pause: float = WINDOW) -> float:
    """Messages a second since the last `pause` (s); 0 in silence, not-a-number for a first message that is alone.

    `stamps` and `now` are in ns, `stamps` ascending.
    """
    recent = stamps[stamps > now - round(WINDOW * NANOSECONDS)]
    if not len(recent):
        return 0.0
    gaps = np.diff(recent, append=max(now, int(recent[-1]))) / NANOSECONDS
    if gaps[-1] > pause:
        return 0.0
    breaks = np.flatnonzero(gaps[:-1] > pause)
    steps = gaps[breaks[-1] + 1 if len(breaks) else 0 : -1]
    if not len(steps):
        return float("nan")
    span = float(steps.sum())
    overdue = max(0.0, float(gaps[-1]) - 2 * span / len(steps))
    return len(steps) / (span + overdue) if span + overdue > 0 else float("nan")


def verdict(hertz: float, expected: float) -> str:
    """ "as expected", "too slow", "too fast", "silent", or "just begun" """
    if np.isnan(hertz):
        return "just begun"
    if hertz == 0:
        return "silent"
    if hertz < (1 - TOLERANCE) * expected:
        return "too slow"
    return "too fast" if hertz > (1 + TOLERANCE) * expected else "as expected"
