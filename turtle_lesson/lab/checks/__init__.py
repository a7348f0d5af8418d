"""Checks of exercises, which look at the running system as any node could: at the graph, messages, answers, parameters.

`page_NN.py` holds the checks of a page, `pages_NN_NN.py` of several; the other modules are what they are made of. How to
write a check is in `lab/README.md`; answers that must fail or pass are in `tests/answers`.
"""

from .probe import Probe, field, interface, remembered
from .registry import Check, Expectation, all_checks, check, checks_of, expectation, find, run
from .results import Advice, CannotLook, CheckResult, Row, Seen

__all__ = [
    "Advice",
    "CannotLook",
    "Check",
    "CheckResult",
    "Expectation",
    "Probe",
    "Row",
    "Seen",
    "all_checks",
    "check",
    "checks_of",
    "expectation",
    "field",
    "find",
    "interface",
    "remembered",
    "run",
]
