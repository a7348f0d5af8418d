"""How often messages come, from the times at which they were sent, and whether that is as it should be."""

from __future__ import annotations

import numpy as np

from ..recording import NANOSECONDS

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
