"""Checks of exercises, which look at the running system as any node could: at the graph, messages, answers, parameters.

`page_NN.py` holds the checks of a page; the other modules are what they are made of. How to write a check is in
`lab/README.md`; answers that must fail or pass are in `tests/answers`.
"""

from .graph_view import field, interface
from .probe import Answer, Heard, Probe, remembered
from .registry import Check, Expectation, all_checks, check, checks_of, expectation, find
from .results import METADATA, Advice, CannotLook, CheckResult, OutOfTime, Row, Seen, Stopped
from .runner import run

__all__ = [
    "METADATA",
    "Advice",
    "Answer",
    "CannotLook",
    "Check",
    "CheckResult",
    "Expectation",
    "Heard",
    "OutOfTime",
    "Probe",
    "Row",
    "Seen",
    "Stopped",
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
