"""The discrete-event core: a virtual clock, timed events and simulated processes. It knows nothing of ROS."""

from .driving import drive
from .errors import DriveTimeout, NeverReturns, NeverWakes, SimulationError, WorldClosed
from .process import Process
from .simulation import EPOCH, NANOSECONDS, Simulation
from .strand import Strand, getcurrent, running_strand

__all__ = [
    "EPOCH",
    "NANOSECONDS",
    "DriveTimeout",
    "NeverReturns",
    "NeverWakes",
    "Process",
    "Simulation",
    "SimulationError",
    "Strand",
    "WorldClosed",
    "drive",
    "getcurrent",
    "running_strand",
]
