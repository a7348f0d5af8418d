"""Trouble on purpose: a system that is broken by public means, a user's report of it, and whether it is mended.

Each trouble is a symptom with several faults behind it; a seed chooses one. Faults are what happens on robots: a node
that was not started, a remapping, a parameter, a quality of service, a type, a bug in a node of `robot_draft`.
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
