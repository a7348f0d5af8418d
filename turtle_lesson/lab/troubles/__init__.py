"""Systems that are broken on purpose, for page 09: a user's report, hints, and a check whether the system works again.

Each trouble is one symptom with several possible faults, one of which is chosen by a seed. The faults are those of
robots: a node that was not started, a remapping, a parameter, a quality of service, a type, a bug in `robot_draft`.
"""

from .cases import TROUBLES, Case, current_expectations, expectations_of, open_case
from .faults import Environment, Fault, Program, Trouble

__all__ = [
    "TROUBLES",
    "Case",
    "Environment",
    "Fault",
    "Program",
    "Trouble",
    "current_expectations",
    "expectations_of",
    "open_case",
]
