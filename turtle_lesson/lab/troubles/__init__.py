"""Systems that are broken on purpose, for page 09: a user's report, hints, and a check whether the system works again.

Each trouble is one symptom with several possible faults, one of which is chosen by a seed. The faults are those of
robots: a node that was not started, a remapping, a parameter, a quality of service, a type, a bug in `robot_draft`.
"""

from .faults import TROUBLES

__all__ = ["TROUBLES"]
