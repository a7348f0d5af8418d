"""What can go wrong with simulated time, each said in words that help."""

from __future__ import annotations


class SimulationError(RuntimeError):
    """The simulation was used in a way that cannot work."""


class NeverWakes(SimulationError):
    """A call waits for something that can never happen."""


class DriveTimeout(SimulationError):
    """A notebook cell waited very long in robot time for something that did not happen."""


class NeverReturns(SimulationError):
    """A callback computes on and on and lets no time pass, so that nothing else can happen."""


class WorldClosed(SimulationError):
    """Something of an earlier world was used after `start()` had made a fresh one."""
