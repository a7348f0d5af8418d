"""Checks of the debugging lab: whether the trouble that was brought in on purpose is mended."""

from __future__ import annotations

from .registry import Expectation, check


@check("trouble", page="09_debugging_lab", points=5, limit=600)
def trouble() -> list[Expectation]:
    """The case is closed: the system does what it should."""
    from ..troubles import current_expectations

    return current_expectations()
